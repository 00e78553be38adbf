// SPDX-License-Identifier: Apache-2.0
//
// FixedInt against GMP: every operation on numbers of every length, and the room that
// scaled_integers.h promises, at the largest coordinates there can be.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "exact/big_int.h"
#include "exact/fixed_int.h"
#include "exact/scaled_integers.h"
#include "predicate/determinants.h"
#include "support/rng.h"
#include "support/run_cases.h"

namespace pierce::exact {
namespace {

using hard::Rng;

mpz_class to_gmp(std::int64_t x) { return mpz_class(std::to_string(x)); }

template <std::size_t N>
mpz_class to_gmp(const FixedInt<N>& a) {
  mpz_class value = 0;
  for (std::size_t i = N; i-- > 0;) value = (value << kDigitBits) + to_gmp(a.digit[i]);
  return value;
}

template <std::size_t N>
void expect_one_way_to_write(const FixedInt<N>& a) {
  constexpr std::int64_t kHalf = std::int64_t{1} << (kDigitBits - 1);
  for (std::size_t i = 0; i + 1 < N; ++i) {
    ASSERT_GE(a.digit[i], -kHalf);
    ASSERT_LT(a.digit[i], kHalf);
  }
}

// Of any length, often with a digit that is 0, the least, or the largest: carries travel far.
template <std::size_t N>
FixedInt<N> draw(Rng& rng) {
  constexpr std::int64_t kHalf = std::int64_t{1} << (kDigitBits - 1);
  FixedInt<N> a;
  const auto digits = static_cast<std::size_t>(rng.below(N + 1));
  for (std::size_t i = 0; i < digits; ++i) {
    a.digit[i] = rng.one_in(4)   ? -kHalf
                 : rng.one_in(4) ? kHalf - 1
                 : rng.one_in(4) ? 0
                                 : low_digit(rng.bits());
  }
  if (digits > 0) a.digit[digits - 1] >>= rng.below(kDigitBits);
  return rng.coin() ? -a : a;
}

template <std::size_t A, std::size_t B>
void compare_with_gmp(Rng& rng) {
  const FixedInt<A> a = draw<A>(rng), a2 = draw<A>(rng);
  const FixedInt<B> b = draw<B>(rng);
  const mpz_class x = to_gmp(a), x2 = to_gmp(a2), y = to_gmp(b);
  ASSERT_EQ(to_gmp(a + a2), x + x2);
  ASSERT_EQ(to_gmp(a - a2), x - x2);
  ASSERT_EQ(to_gmp(-a), -x);
  ASSERT_EQ(to_gmp(a * b), x * y);
  expect_one_way_to_write(a + a2);
  expect_one_way_to_write(a - a2);
  expect_one_way_to_write(-a);
  expect_one_way_to_write(a * b);
  ASSERT_EQ(sign_of(a), sgn(x));
  ASSERT_EQ(to_gmp(widened<A + 2>(a)), x);
  ASSERT_EQ(bit_length(a), x == 0 ? 0 : static_cast<int>(mpz_sizeinbase(x.get_mpz_t(), 2)));
  ASSERT_EQ(mpz_class(to_big(a).str()), x);
  // Lengths that agree after the shift are the hard case.
  int by = rng.between(-400, 400);
  if (rng.coin()) by = bit_length(b) - bit_length(a);
  const auto b2 = draw<B>(rng);
  const mpz_class y2 = to_gmp(b2);
  if constexpr (A <= 8 || B <= 8) {
    ASSERT_EQ(to_gmp(difference_of_products(a, b, a2, b2)), x * y - x2 * y2);
    ASSERT_EQ(to_gmp(sum_of_products(a, b, a2, b2, a2, b)), x * y + x2 * y2 + x2 * y);
  }
  const mpz_class left = by > 0 ? mpz_class(x << static_cast<unsigned>(by)) : x;
  const mpz_class right = by < 0 ? mpz_class(y << static_cast<unsigned>(-by)) : y;
  ASSERT_EQ(compare_scaled(a, by, b), cmp(left, right) < 0 ? -1 : cmp(left, right) > 0 ? 1 : 0);
}

TEST(FixedIntTest, computes_as_gmp_does) {
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 70, i);
    compare_with_gmp<1, 1>(rng);
    compare_with_gmp<2, 1>(rng);
    compare_with_gmp<2, 4>(rng);
    compare_with_gmp<3, 3>(rng);
    compare_with_gmp<6, 6>(rng);
    if (HasFatalFailure()) return;
  }
}

TEST(FixedIntTest, compares_a_number_with_itself_shifted) {
  const FixedInt<2> a{{0x123456789abcdef0, 0x0fedcba987654321}};
  const FixedInt<3> b = a * FixedInt<1>{{1 << 17}};
  EXPECT_EQ(compare_scaled(a, 17, b), 0);
  EXPECT_EQ(compare_scaled(b, -17, a), 0);
  EXPECT_EQ(compare_scaled(a, 16, b), -1);
  EXPECT_EQ(compare_scaled(a, 18, b), 1);
  EXPECT_EQ(compare_scaled(-a, 16, -b), 1);
  EXPECT_EQ(compare_scaled(a, 17, b + FixedInt<3>{{1}}), -1);
  EXPECT_EQ(compare_scaled(a, 17, b - FixedInt<3>{{1}}), 1);
}

// Digits as far from 0 as they may be, in all the products that are summed.
template <std::size_t A, std::size_t B>
void products_fit() {
  constexpr std::int64_t kHalf = std::int64_t{1} << (kDigitBits - 1);
  FixedInt<A> a;
  FixedInt<B> b;
  for (auto& x : a.digit) x = -kHalf;
  for (auto& x : b.digit) x = -kHalf;
  const mpz_class product = to_gmp(a) * to_gmp(b);
  EXPECT_EQ(to_gmp(difference_of_products(a, b, a, -b)), 2 * product);
  EXPECT_EQ(to_gmp(sum_of_products(a, b, a, b, a, b)), 3 * product);
  a.digit[A - 1] = b.digit[B - 1] = -2 * kHalf;  // of three, the last would not fit in its word
  EXPECT_EQ(to_gmp(a * b), to_gmp(a) * to_gmp(b));
}

TEST(FixedIntTest, the_largest_products_fit) {
  products_fit<1, 1>();
  products_fit<2, 2>();
  products_fit<4, 2>();
  products_fit<4, 4>();
  products_fit<8, 4>();
  products_fit<8, 8>();
}

// The determinants of the largest coordinates, all signs: no sum may run over.
template <std::size_t N>
void determinants_fit() {
  constexpr unsigned kBits = kCoordinateBits<N>;
  FixedInt<N> largest;
  largest.digit[N - 1] = std::int64_t{1} << (kBits % kDigitBits);
  largest = largest - FixedInt<N>{{1}};
  const mpz_class largest_gmp = (mpz_class(1) << kBits) - 1;
  ASSERT_EQ(to_gmp(largest), largest_gmp);
  Rng rng(hard::seed() + 71, N);
  using Fixed = predicate::Triple<FixedInt<N>>;
  using Gmp = predicate::Triple<mpz_class>;
  for (int i = 0; i < 4096; ++i) {
    std::uint64_t signs = rng.bits();
    const auto next = [&](Fixed& p, Gmp& q) {
      const auto one = [&](FixedInt<N>& f, mpz_class& g) {
        f = (signs & 1U) != 0 ? largest : -largest;
        g = (signs & 1U) != 0 ? largest_gmp : mpz_class(-largest_gmp);
        signs >>= 1;
      };
      one(p.x, q.x);
      one(p.y, q.y);
      one(p.z, q.z);
    };
    Fixed o, d, a, b, c;
    Gmp og, dg, ag, bg, cg;
    next(o, og);
    next(d, dg);
    next(a, ag);
    next(b, bg);
    next(c, cg);
    const auto fixed = predicate::determinants_of(a - o, b - a, c - a, d);
    const Gmp s{ag.x - og.x, ag.y - og.y, ag.z - og.z}, e{bg.x - ag.x, bg.y - ag.y, bg.z - ag.z},
        f{cg.x - ag.x, cg.y - ag.y, cg.z - ag.z};
    const auto cross = [](const Gmp& p, const Gmp& q) {
      return Gmp{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    };
    const auto dot = [](const Gmp& p, const Gmp& q) {
      return mpz_class(p.x * q.x + p.y * q.y + p.z * q.z);
    };
    const Gmp n = cross(e, f), r = cross(dg, s);
    const mpz_class den = dot(n, dg), u = -dot(r, f), v = dot(r, e), t = dot(n, s);
    ASSERT_EQ(to_gmp(fixed.den), den);
    ASSERT_EQ(to_gmp(fixed.u), u);
    ASSERT_EQ(to_gmp(fixed.v), v);
    ASSERT_EQ(to_gmp(fixed.w), den - u - v);
    ASSERT_EQ(to_gmp(fixed.t), t);
  }
}

TEST(FixedIntTest, the_largest_coordinates_fit_in_one_digit) { determinants_fit<1>(); }
TEST(FixedIntTest, the_largest_coordinates_fit_in_two_digits) { determinants_fit<2>(); }
TEST(FixedIntTest, the_largest_coordinates_fit_in_four_digits) { determinants_fit<4>(); }

TEST(ScaledIntegers, every_double_is_its_integer_times_its_power_of_two) {
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 72, i);
    double x = std::bit_cast<double>(rng.bits());
    if (rng.one_in(4)) x = std::ldexp(rng.symmetric(), -1060);
    if (!std::isfinite(x)) continue;
    const BinaryParts parts = binary_parts(x);
    ASSERT_EQ(std::ldexp(static_cast<double>(parts.significand), parts.exponent), x);
    ASSERT_TRUE(parts.significand == 0 || parts.significand % 2 != 0);
    BitSpan span;
    span.include(x);
    ASSERT_EQ(span.empty(), x == 0);
    if (x == 0) continue;
    ASSERT_LT(std::fabs(std::ldexp(x, -span.high / 2)), std::ldexp(1.0, span.high - span.high / 2));
    ASSERT_LE(span.width(), 53);
    const int below = static_cast<int>(rng.below(6));
    ASSERT_EQ(to_big(scaled_integer<FixedInt<1>>(x, span.low - below)),
              scaled_integer<BigInt>(x, span.low - below));
    const auto far_below = [&](auto zero) {
      using Fixed = decltype(zero);
      const int room = kCoordinateBits<std::tuple_size_v<decltype(zero.digit)>> - span.width();
      const int place = span.low - rng.between(0, room);
      ASSERT_EQ(to_big(scaled_integer<Fixed>(x, place)), scaled_integer<BigInt>(x, place));
      expect_one_way_to_write(scaled_integer<Fixed>(x, place));
    };
    far_below(FixedInt<1>{});
    far_below(FixedInt<2>{});
    far_below(FixedInt<4>{});
  }
}

}  // namespace
}  // namespace pierce::exact
