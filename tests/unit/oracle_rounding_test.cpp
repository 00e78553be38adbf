// SPDX-License-Identifier: Apache-2.0
//
// The oracle's correctly rounded ratio against the processor's: IEEE division is correctly rounded
// for every pair of floats, subnormal and overflowing quotients included.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/hard_numbers.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

template <class Real>
class OracleRounding : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(OracleRounding, Reals);

TYPED_TEST(OracleRounding, a_ratio_of_floats_rounds_as_the_processor_divides) {
  using Real = TypeParam;
  int subnormal = 0, infinite = 0, zero = 0;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    hard::Rng rng(hard::seed(), i);
    const Real x = hard::number<Real>(rng, rng.pick(hard::kAllStyles));
    Real y = hard::number<Real>(rng, rng.pick(hard::kAllStyles));
    if (rng.one_in(4)) y = hard::nudged(std::ldexp(x, rng.between(-3, 3)), rng.between(-2, 2));
    if (y == 0) continue;
    const Real expected = x / y + Real(0);  // + 0 turns -0 into +0
    const Real rounded = oracle::round_ratio<Real>(oracle::Dyadic(x), oracle::Dyadic(y));
    ASSERT_TRUE(show::same_bits(rounded, expected))
        << show::text(x) << " / " << show::text(y) << ": " << show::text(rounded);
    subnormal += std::fpclassify(expected) == FP_SUBNORMAL ? 1 : 0;
    infinite += std::isinf(expected) ? 1 : 0;
    zero += expected == 0 && x != 0 ? 1 : 0;
  }
  EXPECT_GT(subnormal, 100);
  EXPECT_GT(infinite, 100);
  EXPECT_GT(zero, 100);
}

TYPED_TEST(OracleRounding, a_sum_of_floats_rounds_as_the_processor_adds) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    hard::Rng rng(hard::seed(), i);
    const hard::Style style = rng.pick(hard::kAllStyles);
    const Real x = hard::number<Real>(rng, style), y = hard::number<Real>(rng, style);
    const Real rounded = oracle::round_dyadic<Real>(oracle::Dyadic(x) + oracle::Dyadic(y));
    ASSERT_TRUE(show::same_bits(rounded, x + y + Real(0))) << show::text(x) << show::text(y);
  }
}

TYPED_TEST(OracleRounding, ties_go_to_even_at_every_edge) {
  using Real = TypeParam;
  using Limits = std::numeric_limits<Real>;
  const auto half_between = [](Real x, Real y) {
    return oracle::round_ratio<Real>(oracle::Dyadic(x) + oracle::Dyadic(y), oracle::Dyadic(2));
  };
  const Real tiny = Limits::denorm_min();
  EXPECT_EQ(half_between(0, tiny), 0);
  EXPECT_EQ(half_between(tiny, 2 * tiny), 2 * tiny);
  EXPECT_EQ(half_between(2 * tiny, 3 * tiny), 2 * tiny);
  EXPECT_EQ(half_between(-tiny, -2 * tiny), -2 * tiny);
  EXPECT_FALSE(std::signbit(half_between(0, -tiny)));
  EXPECT_EQ(half_between(1, 1 + Limits::epsilon()), 1);
  EXPECT_EQ(half_between(1 + Limits::epsilon(), 1 + 2 * Limits::epsilon()),
            1 + 2 * Limits::epsilon());
  EXPECT_EQ(half_between(Limits::min() - tiny, Limits::min()), Limits::min());
  // Half an ulp above the largest number is the first that rounds to infinity.
  const oracle::Dyadic max(Limits::max());
  const oracle::Dyadic half_ulp(mpz_class(1), Limits::max_exponent - Limits::digits - 1);
  const oracle::Dyadic less(mpz_class(1), -5000);
  EXPECT_EQ(oracle::round_dyadic<Real>(max + half_ulp), Limits::infinity());
  EXPECT_EQ(oracle::round_dyadic<Real>(max + half_ulp - less), Limits::max());
  EXPECT_EQ(oracle::round_dyadic<Real>(less), 0);
}

}  // namespace
}  // namespace pierce
