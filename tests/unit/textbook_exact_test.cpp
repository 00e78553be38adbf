// SPDX-License-Identifier: Apache-2.0
//
// Over an exact rational every textbook method is the definition of a hit. Two rational types, all
// methods, against each other and against Gaussian elimination, on the cases that rounded
// arithmetic finds hard; and the rules at edges, vertices, the ends of the range and beyond.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pierce/textbook.h"
#include "support/hard_cases.h"
#include "support/rational_oracle.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using BoostRational = boost::multiprecision::cpp_rational;

template <class Q>
using Points = std::array<Vec3<Q>, 3>;

// All the methods' common answer; a failure names those that differ.
template <class Q>
std::optional<TextbookHit<Q>> answer_of_all(const Ray<Q>& ray, const Points<Q>& p) {
  const auto& [a, b, c] = p;
  const std::optional<TextbookHit<Q>> expected = textbook::determinants(ray, a, b, c);
  const bool front = dot(cross(b - a, c - a), ray.direction) < 0;
  for (const textbook::Method<Q>& method : textbook::methods<Q>()) {
    if (method.epsilon) continue;
    const std::optional<TextbookHit<Q>> hit = method.test(ray, a, b, c);
    EXPECT_TRUE(method.front_only && !front ? !hit : hit == expected) << method.name;
  }
  const std::optional<Q> t = textbook::plane_then_edges(ray, p);
  EXPECT_EQ(t.has_value(), expected.has_value()) << "plane_then_edges of the polygon";
  if (t && expected) {
    EXPECT_EQ(*t, expected->t);
  }
  return expected;
}

bool same(const mpq_class& x, const mpq_class& y) { return x == y; }
bool same(const BoostRational& x, const mpq_class& y) {
  return x.convert_to<std::string>() == y.get_str();  // both in lowest terms
}

template <class Q, class Real>
void all_methods_agree_with_gaussian_elimination(std::uint64_t count) {
  std::uint64_t hits = 0, misses = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    hard::Rng rng(hard::seed(), i);
    const hard::Case<Real> hard = hard::hard_case<Real>(rng);
    const auto hit = answer_of_all<Q>(convert<Q>(hard.ray),
                                      {convert<Q>(hard.a), convert<Q>(hard.b), convert<Q>(hard.c)});
    const auto expected = oracle::rational_hit(hard.ray, hard.a, hard.b, hard.c);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << "case " << i;
    if (!hit) {
      ++misses;
      continue;
    }
    ++hits;
    ASSERT_TRUE(same(hit->t, expected->t)) << "case " << i;
    ASSERT_TRUE(same(hit->u, expected->u)) << "case " << i;
    ASSERT_TRUE(same(hit->v, expected->v)) << "case " << i;
    if (testing::Test::HasFailure()) FAIL() << "case " << i;
  }
  if (count >= 200) {
    EXPECT_GT(hits, count / 10);
    EXPECT_GT(misses, count / 10);
  }
}

TEST(TextbookExact, all_methods_over_gmp_rationals_agree_on_hard_float_cases) {
  all_methods_agree_with_gaussian_elimination<mpq_class, float>(hard::case_count(4000));
}

TEST(TextbookExact, all_methods_over_gmp_rationals_agree_on_hard_double_cases) {
  all_methods_agree_with_gaussian_elimination<mpq_class, double>(hard::case_count(2000));
}

TEST(TextbookExact, all_methods_over_boost_rationals_agree_on_hard_float_cases) {
  all_methods_agree_with_gaussian_elimination<BoostRational, float>(hard::case_count(500));
}

TEST(TextbookExact, all_methods_over_boost_rationals_agree_on_hard_double_cases) {
  all_methods_agree_with_gaussian_elimination<BoostRational, double>(hard::case_count(200));
}

template <class Q>
class TextbookOverRational : public testing::Test {
 protected:
  static Q third() { return Q(1) / 3; }
  static Points<Q> triangle() {
    return {{{Q(0), Q(0), Q(0)}, {Q(1), Q(0), Q(0)}, {Q(0), Q(1), Q(0)}}};
  }
  // Straight down through (x, y, 0), from z = 1, over a direction that is not of unit length.
  static Ray<Q> down(const Q& x, const Q& y) { return {{x, y, Q(1)}, {Q(0), Q(0), Q(-3)}}; }
};

using Rationals = testing::Types<mpq_class, BoostRational>;
TYPED_TEST_SUITE(TextbookOverRational, Rationals);

TYPED_TEST(TextbookOverRational, a_hit_has_its_exact_fractions) {
  using Q = TypeParam;
  const auto hit = answer_of_all<Q>(this->down(Q(1) / 7, Q(2) / 7), this->triangle());
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, this->third());
  EXPECT_EQ(hit->u, Q(1) / 7);
  EXPECT_EQ(hit->v, Q(2) / 7);
}

TYPED_TEST(TextbookOverRational, edges_and_vertices_belong_to_the_triangle) {
  using Q = TypeParam;
  const std::vector<std::array<Q, 2>> on = {
      {Q(0), Q(0)},          {Q(1), Q(0)},          {Q(0), Q(1)},
      {this->third(), Q(0)}, {Q(0), this->third()}, {this->third(), 1 - this->third()}};
  for (const auto& [x, y] : on) {
    const auto hit = answer_of_all<Q>(this->down(x, y), this->triangle());
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->u, x);
    EXPECT_EQ(hit->v, y);
  }
}

TYPED_TEST(TextbookOverRational, a_billionth_of_a_billionth_outside_is_a_miss) {
  using Q = TypeParam;
  const Q tiny = Q(1) / Q(1000000000) / Q(1000000000);
  EXPECT_FALSE(answer_of_all<Q>(this->down(-tiny, this->third()), this->triangle()));
  EXPECT_FALSE(answer_of_all<Q>(this->down(this->third(), -tiny), this->triangle()));
  EXPECT_FALSE(
      answer_of_all<Q>(this->down(this->third(), 1 - this->third() + tiny), this->triangle()));
}

TYPED_TEST(TextbookOverRational, a_ray_in_the_plane_never_hits) {
  using Q = TypeParam;
  const std::vector<Vec3<Q>> directions = {
      {Q(1), Q(0), Q(0)}, {Q(0), Q(-1), Q(0)}, {Q(1), Q(2), Q(0)}};
  for (const Vec3<Q>& d : directions) {
    EXPECT_FALSE(answer_of_all<Q>({{Q(0), Q(0), Q(0)}, d}, this->triangle()));
    EXPECT_FALSE(answer_of_all<Q>({{Q(-1), Q(1) / 4, Q(0)}, d}, this->triangle()));
    EXPECT_FALSE(answer_of_all<Q>({{Q(0), Q(0), Q(1)}, d}, this->triangle())) << "parallel above";
  }
}

TYPED_TEST(TextbookOverRational, a_triangle_without_area_never_hits) {
  using Q = TypeParam;
  const Vec3<Q> o = {Q(0), Q(0), Q(0)}, x = {Q(1), Q(0), Q(0)};
  const Vec3<Q> on_it = {this->third(), Q(0), Q(0)};
  for (const Points<Q>& p :
       {Points<Q>{o, x, on_it}, Points<Q>{o, x, x}, Points<Q>{o, o, o}, Points<Q>{x, o, on_it}}) {
    EXPECT_FALSE(answer_of_all<Q>(this->down(Q(0), Q(0)), p));
    EXPECT_FALSE(answer_of_all<Q>(this->down(Q(1) / 4, Q(0)), p));
  }
}

TYPED_TEST(TextbookOverRational, the_default_range_is_from_0_to_infinity) {
  using Q = TypeParam;
  Ray<Q> ray = {{Q(1) / 4, Q(1) / 4, Q(1)}, {Q(0), Q(0), -Q(1) / Q(1000000000)}};
  const auto hit = answer_of_all<Q>(ray, this->triangle());
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, Q(1000000000));
  ray.direction = -ray.direction;
  EXPECT_FALSE(answer_of_all<Q>(ray, this->triangle()));
  ray.t_min = Bound<Q>::minus_infinity();
  EXPECT_TRUE(answer_of_all<Q>(ray, this->triangle()));
  ray.t_min = Bound<Q>::infinity();
  EXPECT_FALSE(answer_of_all<Q>(ray, this->triangle()));
}

TYPED_TEST(TextbookOverRational, both_ends_of_the_range_are_closed) {
  using Q = TypeParam;
  const Q tiny = Q(1) / Q(1000000000);
  const auto with_range = [&](const Q& t_min, const Q& t_max) {
    Ray<Q> ray = this->down(Q(1) / 4, Q(1) / 4);
    ray.t_min = t_min;
    ray.t_max = t_max;
    return answer_of_all<Q>(ray, this->triangle()).has_value();
  };
  const Q t = this->third();
  EXPECT_TRUE(with_range(t, t));
  EXPECT_TRUE(with_range(t, t + tiny));
  EXPECT_TRUE(with_range(t - tiny, t));
  EXPECT_FALSE(with_range(t + tiny, Q(1)));
  EXPECT_FALSE(with_range(Q(0), t - tiny));
  EXPECT_FALSE(with_range(t + tiny, t - tiny)) << "an empty range";
}

TYPED_TEST(TextbookOverRational, a_convex_polygon_has_the_hits_of_its_triangles) {
  using Q = TypeParam;
  const Vec3<Q> a = {Q(0), Q(0), Q(0)}, b = {Q(2), Q(0), Q(1)}, c = {Q(2), Q(2), Q(1)},
                d = {Q(0), Q(2), Q(0)};
  const std::vector<Vec3<Q>> quad = {a, b, c, d}, reversed = {d, c, b, a};
  const std::vector<Vec3<Q>> with_straight_and_repeated = {a, {Q(1), Q(0), Q(1) / 2}, b, b, c, d};
  int hits = 0;
  for (int x = -1; x <= 9; ++x) {
    for (int y = -1; y <= 9; ++y) {
      const Ray<Q> ray = this->down(Q(x) / 4, Q(y) / 4);
      Ray<Q> line = ray;
      line.t_min = Bound<Q>::minus_infinity();
      const auto one = textbook::cramer(line, a, b, c), other = textbook::cramer(line, a, c, d);
      for (const auto& corners : {quad, reversed, with_straight_and_repeated}) {
        const auto t = textbook::plane_then_edges(line, corners);
        ASSERT_EQ(t.has_value(), one || other) << x << " " << y;
        if (!t) continue;
        EXPECT_EQ(*t, one ? one->t : other->t);
        ++hits;
      }
    }
  }
  EXPECT_EQ(hits, 3 * 9 * 9);
}

TEST(TextbookExactConversion, infinite_ends_stay_infinite_and_finite_ones_exact) {
  const Ray<float> ray = {{0, 0, 1}, {0, 0, -1}, 0x1.fffffep-1f};
  const Ray<mpq_class> exact = convert<mpq_class>(ray);
  EXPECT_FALSE(in_range(exact, mpq_class(0)));
  EXPECT_TRUE(in_range(exact, mpq_class(0x1.fffffep-1)));
  EXPECT_TRUE(in_range(exact, mpq_class(1e300)));
  const Ray<double> wider = convert<double>(ray);
  EXPECT_EQ(wider.t_min, 0x1.fffffep-1);
  EXPECT_EQ(wider.t_max, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace pierce
