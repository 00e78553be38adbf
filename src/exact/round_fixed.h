// SPDX-License-Identifier: Apache-2.0
//
// A fraction of fixed-width integers, rounded once: what round_ratio.h promises, without memory of
// its own and without a long division. The quotient of the leading 64 bits of both says how to
// round, unless it lies so near the border between two results that it takes the whole numbers to
// tell on which side they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "exact/big_int.h"
#include "exact/fixed_int.h"
#include "exact/round_places.h"
#include "exact/round_ratio.h"

namespace pierce::exact {

/// numerator / denominator * 2^exponent rounded to the nearest Real. The denominator is positive.
template <class Real, std::size_t A, std::size_t B>
Real round_ratio(const FixedInt<A>& numerator, const FixedInt<B>& denominator, int exponent) {
  constexpr int kDigits = std::numeric_limits<Real>::digits;
  const int sign = sign_of(numerator);
  if (sign == 0) return 0;
  const auto n = magnitude(numerator);
  const auto d = magnitude(denominator);
  const int n_length = bit_length(n), d_length = bit_length(d);
  // The ratio lies in (2^(size - 1), 2^(size + 1)), as in round_ratio.cpp.
  const int size = n_length - d_length + exponent;
  if (size - 1 - kDigits < lowest_place<Real>())
    return round_ratio<Real>(to_big(numerator), to_big(denominator), exponent);

  // n / d 2^62, in (2^61, 2^63): what is left out of n and of d changes it by less than
  // 2^-63 of itself each, and the division's own rounding by less than 1.
  constexpr std::uint64_t kOff = 4;
  const auto quotient = static_cast<std::uint64_t>((Uint128{bits_before(n, n_length)} << 62) /
                                                   bits_before(d, d_length));
  const int place = size - 62;
  const int drop = static_cast<int>(std::bit_width(quotient)) - kDigits;
  const std::uint64_t half = std::uint64_t{1} << (drop - 1);
  const std::uint64_t below = quotient & (2 * half - 1);
  Real result = 0;
  if (below < half - kOff || below > half + kOff) {
    result = round_places<Real>(quotient, true, place);
  } else {
    const std::uint64_t kept = quotient >> drop;
    const FixedInt<1> border{{static_cast<std::int64_t>(2 * kept + 1)}};
    const int side = compare_scaled(numerator, exponent - (place + drop - 1),
                                    sign < 0 ? denominator * -border : denominator * border);
    const bool less = side * sign < 0;
    result = round_places<Real>(4 * kept + (less ? 1 : 2), side != 0, place + drop - 2);
  }
  return sign < 0 ? -result : result;
}

}  // namespace pierce::exact
