// SPDX-License-Identifier: Apache-2.0
//
// A fraction of fixed-width integers, or the root of one, rounded once: what round_ratio.h
// promises, without memory of its own and without a long division. The quotient of the leading 64
// bits of both says how to round, unless it, or its root, lies so near the border between two
// results that it takes the whole numbers to tell on which side they are.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "exact/big_int.h"
#include "exact/fixed_int.h"
#include "exact/round_places.h"
#include "exact/round_ratio.h"

namespace pierce::exact {

/// `leading`, less than `kLeadingOff` units of 2^place off, rounded to the nearest Real.
/// `compare(border, place)` is the sign of what is rounded less border 2^place.
inline constexpr std::uint64_t kLeadingOff = 8;
template <class Real, class Compare>
Real round_leading(std::uint64_t leading, int place, const Compare& compare) {
  const int drop = static_cast<int>(std::bit_width(leading)) - std::numeric_limits<Real>::digits;
  const std::uint64_t half = std::uint64_t{1} << (drop - 1);
  const std::uint64_t below = leading & (2 * half - 1);
  if (below < half - kLeadingOff || below > half + kLeadingOff) {
    return round_places<Real>(leading, true, place);
  }
  const std::uint64_t kept = leading >> drop;
  const FixedInt<1> border{{static_cast<std::int64_t>(2 * kept + 1)}};
  const int side = compare(border, place + drop - 1);
  return round_places<Real>(4 * kept + (side < 0 ? 1 : 2), side != 0, place + drop - 2);
}

/// numerator / denominator * 2^exponent rounded to the nearest Real. The denominator is positive.
template <class Real, std::size_t A, std::size_t B>
Real round_ratio(const FixedInt<A>& numerator, const FixedInt<B>& denominator, int exponent) {
  const int sign = sign_of(numerator);
  if (sign == 0) return 0;
  const auto n = magnitude(numerator);
  const auto d = magnitude(denominator);
  const int n_length = bit_length(n), d_length = bit_length(d);
  // The ratio lies in (2^(size - 1), 2^(size + 1)), as in round_ratio.cpp.
  const int size = n_length - d_length + exponent;
  if (size - 1 - std::numeric_limits<Real>::digits < lowest_place<Real>())
    return round_ratio<Real>(to_big(numerator), to_big(denominator), exponent);

  // n / d 2^62, in (2^61, 2^63): what is left out of n and of d changes it by less than
  // 2^-63 of itself each, and the division's own rounding by less than 1: less than 3 in all.
  const auto quotient = static_cast<std::uint64_t>((Uint128{bits_before(n, n_length)} << 62) /
                                                   bits_before(d, d_length));
  const auto compare = [&](const FixedInt<1>& border, int place) {
    return sign * compare_scaled(numerator, exponent - place,
                                 sign < 0 ? denominator * -border : denominator * border);
  };
  const Real result = round_leading<Real>(quotient, size - 62, compare);
  return sign < 0 ? -result : result;
}

/// The root of a number from 2^123 to below 2^126, at most 2 off.
inline std::uint64_t near_root(Uint128 square) {
  // The root of the double is off by 2^-52 of it; then the tangent leaves less than 1.
  const auto first = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(square)));
  const auto rest = static_cast<Int128>(square) - static_cast<Int128>(Uint128{first} * first);
  const double step = static_cast<double>(rest) / (2 * static_cast<double>(first));
  return first + static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
}

/// The square root of numerator / denominator, times 2^exponent, rounded likewise. The numerator is
/// not negative, the denominator positive.
template <class Real, std::size_t A, std::size_t B>
Real round_root(const FixedInt<A>& numerator, const FixedInt<B>& denominator, int exponent) {
  if (sign_of(numerator) == 0) return 0;
  const auto n = magnitude(numerator);
  const auto d = magnitude(denominator);
  const int n_length = bit_length(n), d_length = bit_length(d);
  // The ratio lies in (2^(size - 1), 2^(size + 1)).
  const int size = n_length - d_length;
  const int odd = size & 1;
  const int place = (size - odd) / 2 - 62 + exponent;
  if (place + 61 - std::numeric_limits<Real>::digits < lowest_place<Real>())
    return round_root<Real>(to_big(numerator), to_big(denominator), exponent);

  // As in round_ratio, off by 2^-62 of itself and 1; its root, which is below 2^63, by half the
  // share: 1 and 1, and the 2 of near_root.
  const auto quotient = static_cast<std::uint64_t>((Uint128{bits_before(n, n_length)} << 62) /
                                                   bits_before(d, d_length));
  const auto compare = [&](const FixedInt<1>& border, int border_place) {
    return compare_scaled(numerator, 2 * (exponent - border_place),
                          denominator * (border * border));
  };
  return round_leading<Real>(near_root(Uint128{quotient} << (62 + odd)), place, compare);
}

}  // namespace pierce::exact
