// SPDX-License-Identifier: Apache-2.0
//
// A fraction of fixed-width integers, rounded once: what round_ratio.h promises, without memory of
// its own and without a long division. The quotient is guessed from the leading 64 bits of both and
// put right by the exact remainder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "exact/big_int.h"
#include "exact/fixed_int.h"
#include "exact/round_places.h"
#include "exact/round_ratio.h"

namespace pierce::exact {

/// The leading 64 bits of a positive number of `length` bits, the first of them 1.
template <std::size_t N>
double leading_bits(const FixedInt<N>& a, int length) {
  const auto last = static_cast<std::size_t>(length - 1) / 64;
  const auto unused = static_cast<unsigned>(63 - (length - 1) % 64);
  std::uint64_t top = a.limb[last] << unused;
  if (unused > 0 && last > 0) top |= a.limb[last - 1] >> (64 - unused);
  return static_cast<double>(top);
}

/// numerator / denominator * 2^exponent rounded to the nearest Real. The denominator is positive.
template <class Real, std::size_t A, std::size_t B>
Real round_ratio(const FixedInt<A>& numerator, const FixedInt<B>& denominator, int exponent) {
  constexpr int kDigits = std::numeric_limits<Real>::digits;
  const int sign = sign_of(numerator);
  if (sign == 0) return 0;
  const FixedInt<A> n = sign < 0 ? -numerator : numerator;
  const int n_length = bit_length(n), d_length = bit_length(denominator);
  // The ratio lies in (2^(size - 1), 2^(size + 1)), as in round_ratio.cpp.
  const int size = n_length - d_length + exponent;
  const int place = size - kDigits - 2;
  if (place < lowest_place<Real>() - 2)
    return round_ratio<Real>(to_big(numerator), to_big(denominator), exponent);

  // Within 2^-51 of n / d times 2^(kDigits + 2 + ...): at most 32 away from its floor.
  const double guess = leading_bits(n, n_length) / leading_bits(denominator, d_length);
  auto quotient = static_cast<std::int64_t>(std::ldexp(guess, kDigits + 2));

  // n 2^shift is below 2^(d_length + kDigits + 4); where shift is negative, what is shifted instead
  // has hardly more bits than n.
  const int shift = exponent - place;
  constexpr std::size_t kWide = std::max(A, B + 1) + 1;
  auto rest = widened<kWide>(n);
  auto unit = widened<kWide>(denominator);
  if (shift > 0) rest = shifted_left(rest, static_cast<unsigned>(shift));
  if (shift < 0) unit = shifted_left(unit, static_cast<unsigned>(-shift));
  const auto taken = denominator * FixedInt<1>{{static_cast<std::uint64_t>(quotient)}};
  const auto wide_taken = widened<kWide>(taken);
  rest = rest - (shift < 0 ? shifted_left(wide_taken, static_cast<unsigned>(-shift)) : wide_taken);
  for (; rest.negative(); --quotient) rest = rest + unit;
  for (auto less = rest - unit; !less.negative(); less = rest - unit) {
    rest = less;
    ++quotient;
  }
  const Real result =
      round_places<Real>(static_cast<std::uint64_t>(quotient), sign_of(rest) != 0, place);
  return sign < 0 ? -result : result;
}

}  // namespace pierce::exact
