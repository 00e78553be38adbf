// SPDX-License-Identifier: Apache-2.0
//
// Hit points and normals, each coordinate correctly rounded, against rationals over GMP: hard pairs
// of every style of number, needles, rounding ties, subnormal and infinite results. A component of
// a unit normal is held against its square: no root is taken here.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "pierce/intersect.h"
#include "pierce/scene.h"
#include "pierce/vector.h"
#include "support/hard_cases.h"
#include "support/rational_oracle.h"
#include "support/rng.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;
using Exact = std::array<mpq_class, 3>;

template <class Real>
Exact exact(const Vec3<Real>& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

template <class Real>
Exact exact_normal(const Vec3<Real>& a_real, const Vec3<Real>& b_real, const Vec3<Real>& c_real) {
  const Exact a = exact(a_real), b = exact(b_real), c = exact(c_real);
  Exact n;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
  }
  return n;
}

template <class Real>
Vec3<Real> rounded(const Exact& x) {
  return {oracle::round_rational<Real>(x[0]), oracle::round_rational<Real>(x[1]),
          oracle::round_rational<Real>(x[2])};
}

template <class Real>
bool same_bits(const Vec3<Real>& p, const Vec3<Real>& q) {
  const auto same = [](Real x, Real y) { return x == y && std::signbit(x) == std::signbit(y); };
  return same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z);
}

template <class Real>
bool is_even(Real x) {
  int exponent = 0;
  const Real m = std::frexp(x, &exponent);
  // In units of the last place that the number has, a subnormal one's being that of all of them.
  const int last =
      std::max(exponent - std::numeric_limits<Real>::digits,
               std::numeric_limits<Real>::min_exponent - std::numeric_limits<Real>::digits);
  return std::fmod(std::ldexp(m, exponent - last), Real(2)) == 0;
}

/// Whether x is the root of `square`, 0 <= square <= 1, rounded to the nearest, ties to even.
template <class Real>
bool is_rounded_root(Real x, const mpq_class& square) {
  if (!(x >= 0 && x <= 1)) return false;
  const auto half_way = [&](Real other) -> mpq_class {
    return (mpq_class(static_cast<double>(x)) + mpq_class(static_cast<double>(other))) / 2;
  };
  const mpq_class above = half_way(std::nextafter(x, Real(2)));
  const mpq_class below = x == 0 ? mpq_class(0) : half_way(std::nextafter(x, Real(-1)));
  const int over = cmp(square, above * above), under = cmp(square, below * below);
  if (over > 0 || under < 0) return false;
  return (over < 0 && (under > 0 || x == 0)) || is_even(x);
}

template <class Real>
void expect_unit_normal(const Vec3<Real>& got, const Exact& n) {
  const mpq_class square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const std::array<Real, 3> x = {got.x, got.y, got.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const bool negative = sgn(n[i]) < 0 && x[i] != 0;
    ASSERT_EQ(std::signbit(x[i]), negative);
    const mpq_class ratio = sgn(square) == 0 ? mpq_class(0) : mpq_class(n[i] * n[i] / square);
    ASSERT_TRUE(is_rounded_root(std::fabs(x[i]), ratio)) << show::text(got) << " component " << i;
  }
}

template <class Real>
class Places : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Places, Reals);

TYPED_TEST(Places, of_hard_pairs_are_rounded_once) {
  using Real = TypeParam;
  std::uint64_t hits = 0, flat = 0;
  for (std::uint64_t i = 0; i < hard::case_count(30000); ++i) {
    Rng rng(hard::seed() + 900, i);
    const auto c = hard::hard_case<Real>(rng);
    const Exact n = exact_normal(c.a, c.b, c.c);
    ASSERT_TRUE(same_bits(normal(c.a, c.b, c.c), rounded<Real>(n)))
        << i << show::text(c.a) << show::text(c.b) << show::text(c.c);
    expect_unit_normal(unit_normal(c.a, c.b, c.c), n);
    if (testing::Test::HasFatalFailure()) {
      FAIL() << i << show::text(c.a) << show::text(c.b) << show::text(c.c);
    }
    flat += sgn(n[0]) == 0 && sgn(n[1]) == 0 && sgn(n[2]) == 0 ? 1 : 0;
    auto line = c.ray;
    line.t_min = -kInfinity<Real>;
    line.t_max = kInfinity<Real>;
    const auto hit = oracle::rational_hit(line, c.a, c.b, c.c);
    if (!hit) {
      EXPECT_THROW((void)hit_point(c.ray, c.a, c.b, c.c), Error);
      continue;
    }
    ++hits;
    Exact point = exact(c.ray.origin);
    const Exact d = exact(c.ray.direction);
    for (std::size_t k = 0; k < 3; ++k) point[k] += hit->t * d[k];
    ASSERT_TRUE(same_bits(hit_point(c.ray, c.a, c.b, c.c), rounded<Real>(point)))
        << i << show::text(c.ray) << show::text(c.a) << show::text(c.b) << show::text(c.c);
  }
  if (hard::enough_cases(30000)) {
    EXPECT_GT(hits, hard::case_count(30000) / 10);
    EXPECT_GT(flat, 0U);
  }
}

// Corners whose normal lies half way between two numbers, or as near to that as can be.
TYPED_TEST(Places, normals_at_rounding_ties) {
  using Real = TypeParam;
  constexpr int kBits = std::numeric_limits<Real>::digits;
  std::uint64_t ties = 0;
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 901, i);
    const auto whole = [&](int bits) {
      return static_cast<Real>(std::nearbyint(std::ldexp(rng.symmetric(), bits)));
    };
    const Vec3<Real> a{0, 0, 0};
    const Vec3<Real> b{whole(kBits / 2 + 1), whole(kBits / 2), whole(rng.between(1, kBits / 2))};
    const Vec3<Real> c{whole(kBits / 2), whole(kBits / 2 + 1), whole(rng.between(1, kBits / 2))};
    const Exact n = exact_normal(a, b, c);
    const Vec3<Real> got = normal(a, b, c);
    ASSERT_TRUE(same_bits(got, rounded<Real>(n))) << i;
    const mpq_class left = n[2] - mpq_class(static_cast<double>(got.z));
    const mpq_class ulp =
        static_cast<double>(std::nextafter(std::fabs(got.z), kInfinity<Real>) - std::fabs(got.z));
    ties += cmp(abs(left) * 2, ulp) == 0 ? 1 : 0;
    expect_unit_normal(unit_normal(a, b, c), n);
  }
  if (hard::enough_cases(20000)) {
    EXPECT_GT(ties, 100U);
  }
}

TYPED_TEST(Places, at_the_ends_of_the_type) {
  using Real = TypeParam;
  const Real max = std::numeric_limits<Real>::max();
  const Real least = std::numeric_limits<Real>::denorm_min();
  using Vec = Vec3<Real>;
  // Too large, too small, and a unit normal all the same.
  EXPECT_TRUE(
      same_bits(normal<Real>({0, 0, 0}, {max, 0, 0}, {0, max, 0}), Vec{0, 0, kInfinity<Real>}));
  EXPECT_TRUE(
      same_bits(normal<Real>({0, 0, 0}, {0, max, 0}, {max, 0, 0}), Vec{0, 0, -kInfinity<Real>}));
  EXPECT_TRUE(same_bits(normal<Real>({0, 0, 0}, {least, 0, 0}, {0, -least, 0}), Vec{0, 0, 0}));
  EXPECT_TRUE(
      same_bits(unit_normal<Real>({0, 0, 0}, {least, 0, 0}, {0, -least, 0}), Vec{0, 0, -1}));
  EXPECT_TRUE(same_bits(unit_normal<Real>({-max, 0, 0}, {max, 0, 0}, {0, max, 0}), Vec{0, 0, 1}));
  EXPECT_TRUE(same_bits(unit_normal<Real>({1, 1, 1}, {2, 2, 2}, {3, 3, 3}), Vec{0, 0, 0}));
  EXPECT_TRUE(same_bits(unit_normal<Real>({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), Vec{0, 0, 0}));
  // A component that is subnormal, and one that is too small.
  expect_unit_normal(unit_normal<Real>({0, 0, 0}, {max / 4, 0, 3 * least}, {0, 1, 0}),
                     exact_normal<Real>({0, 0, 0}, {max / 4, 0, 3 * least}, {0, 1, 0}));
  expect_unit_normal(unit_normal<Real>({0, 0, 0}, {1, 0, 3 * least}, {0, 1, 0}),
                     exact_normal<Real>({0, 0, 0}, {1, 0, 3 * least}, {0, 1, 0}));
  // -0.0 in, +0 out; the ray's own coordinates and the plane's come back as they are.
  const Vec point = hit_point<Real>({{-Real(0), Real(0.1), 3}, {-Real(0), 0, -1}},
                                    {-1, -1, Real(0.3)}, {1, -1, Real(0.3)}, {0, 2, Real(0.3)});
  EXPECT_TRUE(same_bits(point, Vec{0, Real(0.1), Real(0.3)}));
}

TYPED_TEST(Places, of_a_scene_are_those_of_its_triangles) {
  using Real = TypeParam;
  const std::vector<Vec3<Real>> v = {{0, 0, 0}, {4, 0, 1}, {0, 4, 2}, {0, 0, 5}};
  const std::vector<Triangle> t = {{0, 1, 2}, {0, 1, 1}, {1, 2, 3}};
  const std::vector<MeshView<Real>> meshes = {{v, {}}, {v, t}};
  const auto scene = Scene<Real>::build(meshes);
  const Ray<Real> ray{{1, 1, 9}, {Real(0.01), 0, -1}};
  const auto far = scene.closest_hit(ray, {.skip = {1, 2}}).value();
  const auto near = scene.closest_hit(ray).value();
  EXPECT_TRUE(same_bits(scene.hit_point(ray, far), hit_point(ray, v[0], v[1], v[2])));
  EXPECT_TRUE(same_bits(scene.normal(far), normal(v[0], v[1], v[2])));
  EXPECT_TRUE(same_bits(scene.unit_normal(near), unit_normal(v[1], v[2], v[3])));
  EXPECT_EQ(scene.compare_hits(ray, far, near), std::strong_ordering::greater);
  EXPECT_EQ(scene.compare_hits(ray, near, far), std::strong_ordering::less);
  EXPECT_EQ(scene.compare_hits(ray, near, near), std::strong_ordering::equal);

  std::vector<Ray<Real>> rays(3000, ray);
  rays[1].origin.x = std::numeric_limits<Real>::quiet_NaN();
  std::vector<Hit<Real>> hits(3000, far);
  hits[1] = {};
  hits[2] = near;
  std::vector<TriangleRef> refs(hits.begin(), hits.end());
  refs[4] = {1, 1};
  std::vector<Vec3<Real>> points(3000, {7, 7, 7}), normals(3000), units(3000);
  scene.hit_points(rays, hits, points, {.threads = 2});
  scene.normals(hits, normals, {.threads = 2});
  scene.unit_normals(refs, units, {.threads = 2});
  for (std::size_t i = 0; i < 3000; ++i) {
    if (i == 1) {  // a miss has none
      for (const auto& p : {points[i], normals[i], units[i]}) {
        ASSERT_TRUE(std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z));
      }
      continue;
    }
    ASSERT_TRUE(same_bits(points[i], scene.hit_point(ray, hits[i]))) << i;
    ASSERT_TRUE(same_bits(normals[i], scene.normal(hits[i]))) << i;
    ASSERT_TRUE(same_bits(units[i], scene.unit_normal(refs[i]))) << i;
    if (i == 4) {  // without area
      ASSERT_EQ(units[i], (Vec3<Real>{0, 0, 0}));
    }
  }
}

TYPED_TEST(Places, bad_hits_are_named) {
  using Real = TypeParam;
  const std::vector<Vec3<Real>> v = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const std::vector<Triangle> t = {{0, 1, 2}};
  const auto scene = Scene<Real>::build({v, t});
  const Ray<Real> ray{{1, 1, 1}, {0, 0, -1}}, beside{{9, 1, 1}, {0, 0, -1}};
  const auto refused = [](const auto& call, const std::string& text, std::uint64_t index,
                          std::uint64_t count) {
    try {
      call();
      ADD_FAILURE() << "not refused: " << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidArgument);
      EXPECT_EQ(e.what(), text);
      EXPECT_EQ(e.index(), index);
      EXPECT_EQ(e.count(), count);
    }
  };
  const auto none = Error::kNoIndex;
  const Hit<Real> hit = scene.closest_hit(ray).value();
  refused([&] { (void)scene.hit_point(beside, hit); },
          "the ray's line does not hit triangle 0 of geometry 0; give a hit that this scene found "
          "for it",
          none, 1);
  refused(
      [&] {
        (void)scene.compare_hits(ray, hit, {0, 3});
      },
      "the ray's line does not hit triangle 3 of geometry 0; give a hit that this scene found "
      "for it",
      none, 1);
  refused(
      [&] {
        (void)scene.normal({0, 3});
      },
      "bad triangle: there is no triangle 3 of geometry 0; name one of the scene", none, 1);
  std::vector<Vec3<Real>> out(3);
  const std::vector<TriangleRef> refs = {{0, 0}, {2, 0}, {0, 9}};
  refused([&] { scene.normals(refs, out); },
          "bad triangle 1 (the first of 2): there is no triangle 0 of geometry 2; name one of the "
          "scene",
          1, 2);
  const std::vector<Ray<Real>> rays = {ray, ray, beside};
  const std::vector<Hit<Real>> hits(3, hit);
  refused([&] { scene.hit_points(rays, hits, out); },
          "ray 2 (the only one) does not hit triangle 0 of geometry 0; give a hit that this scene "
          "found for it",
          2, 1);
}

}  // namespace
}  // namespace pierce
