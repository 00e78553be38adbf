// SPDX-License-Identifier: Apache-2.0
//
// Bounded numbers against GMP rationals: whatever is computed, the true number is within the bound;
// and the root of a ratio is rounded as the oracle rounds it.
#include "exact/bounded.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "exact/round_ratio.h"
#include "support/hard_numbers.h"
#include "support/nearest_oracle.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce::exact {
namespace {

using hard::Rng;
using hard::Style;

mpq_class value_of(double x) { return mpq_class(x); }
mpq_class value_of(const DoubleDouble& x) { return mpq_class(x.high) + mpq_class(x.low); }
Bounded<double> number(double x, double) { return {x, 0}; }
Bounded<DoubleDouble> number(double x, const DoubleDouble&) { return {{x, 0}, 0}; }
bool is_finite(double x) { return std::isfinite(x); }
bool is_finite(const DoubleDouble& x) { return std::isfinite(x.high) && std::isfinite(x.low); }

template <class T>
class BoundedNumbers : public testing::Test {};
using Kinds = testing::Types<double, DoubleDouble>;
TYPED_TEST_SUITE(BoundedNumbers, Kinds);

TYPED_TEST(BoundedNumbers, the_true_number_is_within_the_bound) {
  using Number = Bounded<TypeParam>;
  std::uint64_t checked = 0;
  for (std::uint64_t i = 0; i < hard::case_count(4000); ++i) {
    Rng rng(hard::seed() + 550, i);
    const Style style = rng.pick(hard::kAllStyles);
    std::vector<Number> numbers;
    std::vector<mpq_class> exact;
    for (int k = 0; k < 4; ++k) {
      const double x = hard::number<double>(rng, style);
      numbers.push_back(number(x, TypeParam{}));
      exact.emplace_back(x);
    }
    for (int k = 0; k < 12; ++k) {
      const std::size_t p = rng.below(numbers.size()), q = rng.below(numbers.size());
      Number result;
      mpq_class truth;
      switch (rng.below(4)) {
        case 0:
          result = numbers[p] + numbers[q];
          truth = exact[p] + exact[q];
          break;
        case 1:
          result = numbers[p] - numbers[q];
          truth = exact[p] - exact[q];
          break;
        case 2:
          result = numbers[p] * numbers[q];
          truth = exact[p] * exact[q];
          break;
        default:
          if (exact[q] == 0) continue;
          result = numbers[p] / numbers[q];
          truth = exact[p] / exact[q];
          break;
      }
      if (!std::isfinite(result.err) || !is_finite(result.value)) continue;
      const mpq_class off = abs(value_of(result.value) - truth);
      ASSERT_LE(off, mpq_class(result.err)) << "case " << i << '/' << k;
      ++checked;
      numbers.push_back(result);
      exact.push_back(truth);
      if (truth < 0) continue;
      const Number root = square_root(result);
      if (!std::isfinite(root.err)) continue;
      // |r - sqrt(x)| <= e  <=>  (r - e)^2 <= x <= (r + e)^2
      const mpq_class low = value_of(root.value) - mpq_class(root.err);
      const mpq_class high = value_of(root.value) + mpq_class(root.err);
      ASSERT_TRUE((low < 0 || low * low <= truth) && truth <= high * high) << i << '/' << k;
    }
  }
  if (hard::enough_cases(4000)) {
    EXPECT_GT(checked, 10000u);
  }
}

// 1 + 3 (1 + h) 2^-53 rounds to 1 + 2^-51; less 1, its bound is a quarter of it, and the true
// number just as much smaller: the quotient is off by a third of itself.
TEST(BoundedQuotients, a_denominator_that_may_be_a_quarter_smaller_is_reckoned_with) {
  for (int k = 20; k < 50; ++k) {
    const Bounded<double> small{0x1.8p-52 * (1 + std::ldexp(1.0, -k)), 0}, one{1, 0};
    const Bounded<double> quotient = one / (one + small - one);
    const mpq_class truth = 1 / mpq_class(small.value);
    ASSERT_LE(abs(mpq_class(quotient.value) - truth), mpq_class(quotient.err)) << k;
    ASSERT_LT(quotient.err, 0.34 * quotient.value) << k;
  }
}

template <class Real>
void expect_rounded_root(std::uint64_t seed) {
  for (std::uint64_t i = 0; i < hard::case_count(1500); ++i) {
    Rng rng(hard::seed() + seed, i);
    const auto integer = [&rng](int most) {
      mpz_class n = 1;
      for (int bits = rng.between(1, most); bits > 0; bits -= 60) {
        n = (n << 60) + mpz_class(std::to_string(rng.bits() >> 4));
      }
      return n;
    };
    mpz_class n = integer(400), d = integer(400);
    if (rng.one_in(4)) {  // the square of a number, or of one half way between two
      n = integer(40) >> 36;
      n = n * n + (rng.coin() ? 0 : rng.between(-1, 1));
      d = 1;
    }
    const int exponent = rng.between(-1200, 1200);
    const BigInt big_n(n.get_str()), big_d(d.get_str());
    mpq_class square(n, d);
    square.canonicalize();
    mpz_class power = 1;
    power <<= static_cast<mp_bitcnt_t>(2 * std::abs(exponent));
    const mpq_class scaled = exponent < 0 ? mpq_class(square / power) : mpq_class(square * power);
    const Real expected = oracle::round_square_root<Real>(scaled);
    const Real found = round_root<Real>(big_n, big_d, exponent);
    ASSERT_TRUE(show::same_bits(found, expected))
        << n << " / " << d << " 2^" << exponent << ": " << show::text(found) << " for "
        << show::text(expected);
  }
}

TEST(RoundRoot, is_the_oracles_root_for_floats) { expect_rounded_root<float>(551); }
TEST(RoundRoot, is_the_oracles_root_for_doubles) { expect_rounded_root<double>(552); }

}  // namespace
}  // namespace pierce::exact
