// SPDX-License-Identifier: Apache-2.0
//
// round_ratio and round_root of both kinds of integers against the oracle's (other algorithms, over
// GMP): ordinary ratios, ties, ratios all but at a tie, subnormal results, the border of overflow
// and of zero.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exact/round_fixed.h"
#include "exact/round_ratio.h"
#include "support/nearest_oracle.h"
#include "support/rng.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce::exact {
namespace {

using hard::Rng;

template <class Real>
class RoundRatio : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(RoundRatio, Reals);

BigInt from_gmp(const mpz_class& n) { return BigInt(n.get_str()); }

template <std::size_t N>
bool fits(const mpz_class& n) {
  return mpz_sizeinbase(n.get_mpz_t(), 2) < kDigitBits * N;
}

template <std::size_t N>
FixedInt<N> fixed_from_gmp(const mpz_class& n) {
  FixedInt<N> fixed;
  mpz_class rest = abs(n);
  for (std::int64_t& digit : fixed.digit) {
    digit = std::stoll(mpz_class(rest % (mpz_class(1) << kDigitBits)).get_str());
    rest >>= kDigitBits;
  }
  fixed = carried(fixed);
  return n < 0 ? -fixed : fixed;
}

template <class Real>
void expect_same(const mpz_class& n, const mpz_class& d, int k) {
  const Real expected = oracle::round_ratio<Real>(n, d, k);
  const auto expect = [&](Real found, const char* kind) {
    ASSERT_TRUE(show::same_bits(found, expected))
        << kind << ": " << n << " / " << d << " 2^" << k << ": " << show::text(found) << " for "
        << show::text(expected);
  };
  expect(round_ratio<Real>(from_gmp(n), from_gmp(d), k), "any width");
  if (d < 0) return;  // fixed widths have it positive
  if (fits<3>(n) && fits<3>(d))
    expect(round_ratio<Real>(fixed_from_gmp<3>(n), fixed_from_gmp<3>(d), k), "three digits");
  if (fits<6>(n) && fits<6>(d))
    expect(round_ratio<Real>(fixed_from_gmp<6>(n), fixed_from_gmp<6>(d), k), "six digits");
  if (fits<6>(n) && fits<3>(d))
    expect(round_ratio<Real>(fixed_from_gmp<6>(n), fixed_from_gmp<3>(d), k), "six over three");
}

mpz_class draw(Rng& rng, int most_bits) {
  const int bits = rng.between(1, most_bits);
  mpz_class n = 0;
  for (int i = 0; i < bits; i += 64) n = (n << 64) + mpz_class(std::to_string(rng.bits()));
  n >>= static_cast<mp_bitcnt_t>((bits + 63) / 64 * 64 - bits);
  return rng.coin() ? n : mpz_class(-n);
}

TYPED_TEST(RoundRatio, any_ratio_is_rounded_as_the_oracle_rounds_it) {
  for (std::uint64_t i = 0; i < hard::case_count(10000); ++i) {
    Rng rng(hard::seed() + 80, i);
    const mpz_class n = draw(rng, 700);
    mpz_class d = draw(rng, 700);
    if (d == 0) d = 1;
    expect_same<TypeParam>(n, d, rng.between(-2300, 2300));
    if (this->HasFatalFailure()) return;
  }
}

// (2 m + 1) / 2, exactly half way between two neighbours, and a hair beside it.
// Of numbers that fixed widths hold, with quotients near a power of two and near one another.
TYPED_TEST(RoundRatio, narrow_ratios_are_rounded_as_the_oracle_rounds_them) {
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 85, i);
    mpz_class d = abs(draw(rng, rng.coin() ? 185 : 370));
    if (d == 0) d = 1;
    mpz_class n = draw(rng, rng.coin() ? 185 : 370);
    if (rng.one_in(4)) n = d + rng.between(-1, 1);
    if (rng.one_in(4)) n = (d << static_cast<mp_bitcnt_t>(rng.between(0, 60))) - rng.between(0, 1);
    if (rng.one_in(8)) n = d * draw(rng, 60);
    expect_same<TypeParam>(n, d, rng.between(-200, 200));
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(RoundRatio, ties_go_to_even_and_a_hair_beside_a_tie_does_not) {
  using Limits = std::numeric_limits<TypeParam>;
  constexpr int kLeast = Limits::min_exponent - Limits::digits;  // the last place there is
  for (std::uint64_t i = 0; i < hard::case_count(10000); ++i) {
    Rng rng(hard::seed() + 81, i);
    // Subnormal numbers have fewer bits.
    const int bits = rng.one_in(3) ? rng.between(1, Limits::digits) : Limits::digits;
    const mpz_class significand = (mpz_class(1) << static_cast<mp_bitcnt_t>(bits - 1)) +
                                  mpz_class(std::to_string(rng.bits() >> (64 - bits))) %
                                      (mpz_class(1) << static_cast<mp_bitcnt_t>(bits - 1));
    const mpz_class half = 2 * significand + 1;
    const int place = bits < Limits::digits || rng.one_in(4)
                          ? kLeast - 1
                          : rng.between(kLeast - 1, Limits::max_exponent - Limits::digits - 1);
    const mpz_class factor = 3 + 2 * abs(draw(rng, 200));
    const mpz_class sign = rng.coin() ? 1 : -1;
    expect_same<TypeParam>(sign * half * factor, factor, place);
    const mpz_class fine = mpz_class(1) << 400;
    expect_same<TypeParam>(sign * (half * factor * fine + 1), factor * fine, place);
    expect_same<TypeParam>(sign * (half * factor * fine - 1), factor * fine, place);
    if (this->HasFatalFailure()) return;
  }
}

template <class Real>
void expect_same_root(const mpz_class& n, const mpz_class& d, int k) {
  mpq_class square(n, d);
  square.canonicalize();
  const auto bits = static_cast<mp_bitcnt_t>(2 * std::abs(k));
  square = k < 0 ? mpq_class(square >> bits) : mpq_class(square << bits);
  const Real expected = oracle::round_square_root<Real>(square);
  const auto expect = [&](Real found, const char* kind) {
    ASSERT_TRUE(show::same_bits(found, expected))
        << kind << ": root of " << n << " / " << d << ", 2^" << k << ": " << show::text(found)
        << " for " << show::text(expected);
  };
  expect(round_root<Real>(from_gmp(n), from_gmp(d), k), "any width");
  if (fits<6>(n) && fits<4>(d))
    expect(round_root<Real>(fixed_from_gmp<6>(n), fixed_from_gmp<4>(d), k), "six over four");
  if (fits<12>(n) && fits<8>(d))
    expect(round_root<Real>(fixed_from_gmp<12>(n), fixed_from_gmp<8>(d), k), "twelve over eight");
}

// Of any numbers, of squares of what lies half way between two neighbours, and a hair beside them.
TYPED_TEST(RoundRatio, roots_are_rounded_as_the_oracle_rounds_them) {
  using Limits = std::numeric_limits<TypeParam>;
  constexpr int kLeast = Limits::min_exponent - Limits::digits;
  for (std::uint64_t i = 0; i < hard::case_count(10000); ++i) {
    Rng rng(hard::seed() + 86, i);
    mpz_class d = abs(draw(rng, rng.coin() ? 240 : 490));
    if (d == 0) d = 1;
    const int place = rng.one_in(4) ? kLeast + rng.between(-200, 60) : rng.between(-60, 60);
    if (rng.coin()) {
      expect_same_root<TypeParam>(abs(draw(rng, rng.coin() ? 370 : 740)), d, place);
    } else {
      const mpz_class m = abs(draw(rng, Limits::digits + 1)) | 1;
      const mpz_class factor = abs(draw(rng, 250)) | 1;
      const mpz_class fine = mpz_class(1) << static_cast<mp_bitcnt_t>(rng.between(0, 200));
      const mpz_class tie = m * m * factor * fine;
      expect_same_root<TypeParam>(tie + rng.between(-1, 1), factor * fine, place);
    }
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(RoundRatio, the_ends_of_the_type_are_rounded_as_ieee_says) {
  using Limits = std::numeric_limits<TypeParam>;
  constexpr int kDigits = Limits::digits;
  constexpr int kTop = Limits::max_exponent;
  const BigInt one = 1;
  // Half an ulp above the largest number is infinite; a hair less is the largest number.
  const BigInt edge = (one << (kDigits + 1)) - 1;
  EXPECT_EQ(round_ratio<TypeParam>(edge, one, kTop - kDigits - 1), Limits::infinity());
  EXPECT_EQ(round_ratio<TypeParam>((edge << 300) - 1, one << 300, kTop - kDigits - 1),
            Limits::max());
  EXPECT_EQ(round_ratio<TypeParam>(-edge, one, kTop - kDigits - 1), -Limits::infinity());
  // Half of the least subnormal is 0 (even); a hair more is the least subnormal.
  const int least = Limits::min_exponent - kDigits;
  EXPECT_TRUE(show::same_bits(round_ratio<TypeParam>(one, one, least - 1), TypeParam(0)));
  EXPECT_EQ(round_ratio<TypeParam>((one << 300) + 1, one << 300, least - 1), Limits::denorm_min());
  EXPECT_EQ(round_ratio<TypeParam>(BigInt(3), one, least - 1), 2 * Limits::denorm_min());
  // Whatever rounds to zero is +0, and so is zero.
  EXPECT_TRUE(show::same_bits(round_ratio<TypeParam>(-one, one, least - 1), TypeParam(0)));
  EXPECT_TRUE(show::same_bits(round_ratio<TypeParam>(-one, one, -100000), TypeParam(0)));
  EXPECT_TRUE(show::same_bits(round_ratio<TypeParam>(BigInt(0), -one, 5), TypeParam(0)));
  EXPECT_EQ(round_ratio<TypeParam>(one, -one, 100000), -Limits::infinity());
}

}  // namespace
}  // namespace pierce::exact
