// SPDX-License-Identifier: Apache-2.0
//
// One ray, one triangle, through the public API, against the exact oracle: hit or miss, t, u, v, w
// to the bit, facing; and the order of two hits. 10^5 cases of each in ctest; the long run is
//   PIERCE_CASES=10000000 differential_one_triangle_test
// (support/run_cases.h), well under an hour on two cores. A difference is shrunk, printed and kept
// (support/save_failure.h), and PIERCE_REPLAY=failures.txt looks at what was kept
// (support/kept_cases.h).
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "pierce/intersect.h"
#include "support/hard_cases.h"
#include "support/kept_cases.h"
#include "support/quick_oracle.h"
#include "support/run_cases.h"
#include "support/save_failure.h"
#include "support/show.h"
#include "support/shrink.h"

namespace pierce {
namespace {

template <class Real>
class OneTriangle : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(OneTriangle, Reals);

template <class Real>
Hit<Real> expected(const hard::Case<Real>& c) {
  const auto hit = oracle::LineAndTriangle(c.ray, c.a, c.b, c.c).hit(c.ray, c.range);
  return hit ? oracle::rounded<Real>(*hit, 0, 0) : Hit<Real>{};
}

template <class Real>
Hit<Real> found(const hard::Case<Real>& c) {
  return intersect(c.ray, c.a, c.b, c.c, c.range).value_or(Hit<Real>{});
}

template <class Real>
bool differs(const hard::Case<Real>& c) {
  return !show::same_bits(found(c), expected(c));
}

// A case that differs: made small, kept, and shown.
template <class Real>
void report(std::uint64_t i, const hard::Case<Real>& full) {
  const auto c = hard::shrunk(full, differs<Real>);
  FAIL() << "seed " << hard::seed() << " case " << i << ", shrunk:\n"
         << hard::saved(show::text(c)) << "\nfound:    " << show::text(found(c))
         << "\nexpected: " << show::text(expected(c)) << "\nas drawn:\n"
         << show::text(full);
}

template <class Real, class Make>
void expect_no_difference(std::uint64_t cases, Make make) {
  const auto failure =
      hard::first_failure(cases, [&](std::uint64_t i) { return differs<Real>(make(i)); });
  if (failure) report<Real>(*failure, make(*failure));
}

TYPED_TEST(OneTriangle, hard_cases_are_answered_exactly) {
  using Real = TypeParam;
  if (const auto kept = hard::replayed_cases<Real>()) {
    return expect_no_difference<Real>(kept->size(), [&](std::uint64_t i) { return (*kept)[i]; });
  }
  expect_no_difference<Real>(hard::case_count(100000), [](std::uint64_t i) {
    hard::Rng rng(hard::seed(), i);
    return hard::hard_case<Real>(rng);
  });
}

TYPED_TEST(OneTriangle, ordinary_cases_are_answered_exactly) {
  using Real = TypeParam;
  expect_no_difference<Real>(hard::case_count(50000), [](std::uint64_t i) {
    hard::Rng rng(hard::seed() + 1, i);
    hard::Case<Real> c;
    for (Vec3<Real>* v : {&c.a, &c.b, &c.c, &c.ray.origin})
      *v = hard::vec<Real>(rng, hard::Style::Unit);
    const Real u = static_cast<Real>(rng.unit()), v = static_cast<Real>(rng.unit()) * (1 - u);
    for (std::size_t k = 0; k < 3; ++k) {
      using hard::component;
      const Real target =
          component(c.a, k) * (1 - u - v) + component(c.b, k) * u + component(c.c, k) * v;
      component(c.ray.direction, k) = target - component(c.ray.origin, k);
    }
    return c;
  });
}

TYPED_TEST(OneTriangle, results_at_rounding_ties_go_to_even) {
  using Real = TypeParam;
  expect_no_difference<Real>(hard::case_count(50000), [](std::uint64_t i) {
    hard::Rng rng(hard::seed() + 2, i);
    hard::Case<Real> c;
    do {
      hard::draw_tie(rng, c.ray, c.a, c.b, c.c);
    } while (!hard::is_valid(c.ray) || !hard::is_finite(c.a) || !hard::is_finite(c.b) ||
             !hard::is_finite(c.c));
    return c;
  });
}

TYPED_TEST(OneTriangle, the_ends_of_the_range_are_decided_exactly) {
  using Real = TypeParam;
  static constexpr Real kInf = std::numeric_limits<Real>::infinity();
  // For a hit at t, the only ranges that can go wrong end at a float next to t.
  const auto first_bad_end = [](std::uint64_t i) -> std::optional<hard::Case<Real>> {
    hard::Rng rng(hard::seed() + 3, i);
    auto c = hard::hard_case<Real>(rng);
    c.ray.t_min = -kInf;
    c.ray.t_max = kInf;
    const auto hit = oracle::LineAndTriangle(c.ray, c.a, c.b, c.c).hit(c.ray, Range::Closed);
    if (!hit) return std::nullopt;
    const Real t = oracle::round_ratio<Real>(hit->t_num, hit->den);
    for (const Range range : {Range::Closed, Range::OpenStart}) {
      c.range = range;
      for (int step = -1; step <= 1; ++step) {
        const Real end = hard::nudged(t, step);
        for (const auto& [t_min, t_max] : {std::pair(end, kInf), {-kInf, end}, {end, end}}) {
          c.ray.t_min = t_min;
          c.ray.t_max = t_max;
          if (differs(c)) return c;
        }
      }
    }
    return std::nullopt;
  };
  const auto failure = hard::first_failure(
      hard::case_count(100000) / 10, [&](std::uint64_t i) { return first_bad_end(i).has_value(); });
  if (failure) report<Real>(*failure, *first_bad_end(*failure));
}

TYPED_TEST(OneTriangle, a_case_that_is_kept_reads_back_as_it_was) {
  using Real = TypeParam;
  using Other = std::conditional_t<std::is_same_v<Real, float>, double, float>;
  std::string all;
  for (std::uint64_t i = 0; i < 200; ++i) {
    hard::Rng rng(hard::seed() + 4, i);
    const std::string text = show::text(hard::hard_case<Real>(rng));
    const auto read = hard::cases_in<Real>("Suite.name\n" + text + "\n\n");
    ASSERT_EQ(read.size(), 1U) << text;
    ASSERT_EQ(show::text(read[0]), text);
    all += text + "\n";
  }
  EXPECT_EQ(hard::cases_in<Real>(all).size(), 200U);
  EXPECT_EQ(hard::cases_in<Other>(all).size(), 0U);
}

// As if all hits at the start of an open range were wrong.
TYPED_TEST(OneTriangle, a_failing_case_is_made_small) {
  using Real = TypeParam;
  const auto is_open_at_start = [](const hard::Case<Real>& c) {
    return c.range == Range::OpenStart && expected(c).triangle == kNone &&
           oracle::LineAndTriangle(c.ray, c.a, c.b, c.c).hit(c.ray, Range::Closed).has_value();
  };
  const auto plainness = [](hard::Case<Real> c) {
    int sum = 0;
    for (const Real* x : hard::numbers_of(c)) sum += hard::plainness(*x);
    return sum;
  };
  int drawn = 0, left = 0, tried = 0;
  for (std::uint64_t i = 0; tried < 50; ++i) {
    hard::Rng rng(hard::seed(), i);
    const auto full = hard::hard_case<Real>(rng);
    if (!is_open_at_start(full)) continue;
    ++tried;
    const auto small = hard::shrunk(full, is_open_at_start);
    ASSERT_TRUE(is_open_at_start(small));
    drawn += plainness(full);
    left += plainness(small);
  }
  EXPECT_LT(2 * left, drawn) << left;
}

TYPED_TEST(OneTriangle, a_negative_zero_is_a_zero) {
  using Real = TypeParam;
  const Vec3<Real> a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  for (const Real z : {Real(0), Real(-0.0)}) {
    for (const Real d : {Real(1), Real(-1)}) {
      const auto hit = intersect<Real>({{z, z, z}, {z, -z, d}, z, z}, a, b, c);
      ASSERT_TRUE(hit.has_value());
      EXPECT_TRUE(
          show::same_bits(*hit, Hit<Real>{0, 0, 0, 1, 0, 0, d < 0 ? Facing::Front : Facing::Back}))
          << show::text(*hit);
    }
  }
}

TYPED_TEST(OneTriangle, invalid_input_is_refused) {
  using Real = TypeParam;
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
  const Vec3<Real> a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  const auto code_of = [&](const Ray<Real>& ray, const Vec3<Real>& corner) {
    try {
      (void)intersect(ray, corner, b, c);
    } catch (const Error& error) {
      return std::optional(error.code());
    }
    return std::optional<ErrorCode>();
  };
  const Ray<Real> good{{0, 0, 1}, {0, 0, -1}};
  EXPECT_EQ(code_of(good, a), std::nullopt);
  EXPECT_EQ(code_of({{0, 0, 1}, {0, 0, 0}}, a), ErrorCode::InvalidRay);
  EXPECT_EQ(code_of({{0, 0, 1}, {0, Real(-0.0), 0}}, a), ErrorCode::InvalidRay);
  EXPECT_EQ(code_of({{0, kNan, 1}, {0, 0, 1}}, a), ErrorCode::InvalidRay);
  EXPECT_EQ(code_of({{0, 0, 1}, {0, 0, kInf}}, a), ErrorCode::InvalidRay);
  EXPECT_EQ(code_of({{0, 0, 1}, {0, 0, 1}, kNan, 1}, a), ErrorCode::InvalidRay);
  EXPECT_EQ(code_of({{0, 0, 1}, {0, 0, 1}, 0, kNan}, a), ErrorCode::InvalidRay);
  EXPECT_EQ(code_of(good, {0, kInf, 0}), ErrorCode::NonFiniteVertex);
  EXPECT_EQ(code_of({{0, 0, 1}, {0, 0, -1}, 2, 1}, a), std::nullopt);
}

}  // namespace
}  // namespace pierce
