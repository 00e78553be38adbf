// SPDX-License-Identifier: Apache-2.0
//
// The oracles against each other, before anything is measured against them: Gaussian elimination
// over GMP rationals, side products in dyadic numbers.
#include <gtest/gtest.h>

#include "support/hard_cases.h"
#include "support/quick_oracle.h"
#include "support/rational_crossing.h"
#include "support/rational_oracle.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/save_failure.h"
#include "support/show.h"
#include "support/shrink.h"

namespace pierce {
namespace {

template <class Real>
class Oracles : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Oracles, Reals);

template <class Real>
Hit<Real> by_rationals(const hard::Case<Real>& c) {
  const auto hit = oracle::rational_hit(c.ray, c.a, c.b, c.c, c.range);
  if (!hit) return {};
  using oracle::round_rational;
  return {round_rational<Real>(hit->t),
          round_rational<Real>(hit->u),
          round_rational<Real>(hit->v),
          round_rational<Real>(hit->w),
          0,
          0,
          hit->facing};
}

template <class Real>
Hit<Real> by_sides(const hard::Case<Real>& c) {
  const auto hit = oracle::LineAndTriangle(c.ray, c.a, c.b, c.c).hit(c.ray, c.range);
  return hit ? oracle::rounded<Real>(*hit, 0, 0) : Hit<Real>{};
}

TYPED_TEST(Oracles, agree_on_hits_and_their_rounded_numbers) {
  using Real = TypeParam;
  const auto make = [](std::uint64_t i) {
    hard::Rng rng(hard::seed(), i);
    return hard::hard_case<Real>(rng);
  };
  const auto differs = [](const hard::Case<Real>& c) {
    return !show::same_bits(by_rationals(c), by_sides(c));
  };
  const auto failure = hard::first_failure(hard::case_count(20000),
                                           [&](std::uint64_t i) { return differs(make(i)); });
  if (failure) {
    const auto c = hard::shrunk(make(*failure), differs);
    FAIL() << "seed " << hard::seed() << " case " << *failure << "\n"
           << hard::saved(show::text(c)) << "\n"
           << "rationals: " << show::text(by_rationals(c)) << "\n"
           << "sides:     " << show::text(by_sides(c));
  }
}

TYPED_TEST(Oracles, agree_on_crossings) {
  using Real = TypeParam;
  const auto make = [](std::uint64_t i) {
    hard::Rng rng(hard::seed(), i);
    return hard::hard_case<Real>(rng);
  };
  const auto differs = [](const hard::Case<Real>& c) {
    return oracle::rational_passage(c.ray, c.a, c.b, c.c) !=
           oracle::LineAndTriangle(c.ray, c.a, c.b, c.c).passage(c.ray);
  };
  const auto failure = hard::first_failure(hard::case_count(10000),
                                           [&](std::uint64_t i) { return differs(make(i)); });
  if (failure) {
    const auto c = hard::shrunk(make(*failure), differs);
    FAIL() << "seed " << hard::seed() << " case " << *failure << "\n" << hard::saved(show::text(c));
  }
}

// What the generator is for: every kind of outcome must be frequent.
TYPED_TEST(Oracles, hard_cases_are_hard) {
  using Real = TypeParam;
  int hits = 0, on_edge = 0, on_vertex = 0, grazing = 0, at_end = 0, subnormal = 0, infinite = 0;
  int negative = 0, passages = 0, ties = 0;
  constexpr int kCases = 20000;
  for (int i = 0; i < kCases; ++i) {
    hard::Rng rng(hard::seed(), static_cast<std::uint64_t>(i));
    const auto c = hard::hard_case<Real>(rng);
    const oracle::LineAndTriangle pair(c.ray, c.a, c.b, c.c);
    grazing += pair.den_sign() == 0 ? 1 : 0;
    passages += pair.passage(c.ray) != 0 ? 1 : 0;
    const auto hit = pair.hit(c.ray, Range::Closed);
    if (!hit) continue;
    ++hits;
    const int zeros = (hit->u_num.sign() == 0 ? 1 : 0) + (hit->v_num.sign() == 0 ? 1 : 0) +
                      (hit->w_num.sign() == 0 ? 1 : 0);
    on_edge += zeros == 1 ? 1 : 0;
    on_vertex += zeros == 2 ? 1 : 0;
    at_end +=
        oracle::compare_t(*hit, c.ray.t_min) == 0 || oracle::compare_t(*hit, c.ray.t_max) == 0;
    const auto rounded = oracle::rounded<Real>(*hit, 0, 0);
    subnormal +=
        std::fpclassify(rounded.t) == FP_SUBNORMAL || std::fpclassify(rounded.u) == FP_SUBNORMAL;
    infinite += std::isinf(rounded.t) ? 1 : 0;
    negative += rounded.t < 0 ? 1 : 0;
    ties +=
        oracle::is_tie<Real>(hit->t_num, hit->den) || oracle::is_tie<Real>(hit->u_num, hit->den) ||
        oracle::is_tie<Real>(hit->v_num, hit->den) || oracle::is_tie<Real>(hit->w_num, hit->den);
  }
  std::printf(
      "of %d: hits %d, on an edge %d, at a vertex %d, parallel %d, at an end of the range %d, "
      "subnormal %d, t overflows %d, negative t %d, passages %d, rounding ties %d\n",
      kCases, hits, on_edge, on_vertex, grazing, at_end, subnormal, infinite, negative, passages,
      ties);
  EXPECT_GT(hits, kCases / 5);
  EXPECT_GT(on_edge, kCases / 40);
  EXPECT_GT(on_vertex, kCases / 40);
  EXPECT_GT(grazing, kCases / 40);
  EXPECT_GT(at_end, kCases / 100);
  EXPECT_GT(subnormal, kCases / 1000);
  EXPECT_GT(infinite, kCases / 1000);
  EXPECT_GT(negative, kCases / 100);
  EXPECT_GT(passages, kCases / 10);
  EXPECT_GT(ties, kCases / 100);
}

}  // namespace
}  // namespace pierce
