// SPDX-License-Identifier: Apache-2.0
//
// Doubles that share a power of two, as integers: x = integer * 2^place.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "exact/big_int.h"
#include "exact/binary_parts.h"
#include "exact/fixed_int.h"

namespace pierce::exact {

/// How many bits L a coordinate or a direction may have to enter FixedInt<N>. With L = 62 N - 3,
/// what determinants.h makes of them always fits: differences are below 2^(L + 1), minors below
/// 2^(2L + 3), dot products below 2^(3L + 6) and W below 2^(3L + 7) = 2^(186 N - 2); FixedInt<3 N>
/// holds what is below 2^(186 N + 1).
template <std::size_t N>
inline constexpr int kCoordinateBits = static_cast<int>(N) * kDigitBits - 3;

/// x / 2^place as an integer; place must not be above the lowest bit of x, and x must fit.
template <class Integer>
Integer scaled_integer(double x, int place);

/// x / 2^place, which must be of ordinary size. In two steps, for 2^-place may be no double.
inline double brought_from(double x, int place) {
  const int half = place / 2;
  return x * power_of_two(-half) * power_of_two(half - place);
}

template <>
inline FixedInt<1> scaled_integer<FixedInt<1>>(double x, int place) {
  return {{static_cast<std::int64_t>(brought_from(x, place))}};
}

template <>
inline FixedInt<2> scaled_integer<FixedInt<2>>(double x, int place) {
  const double units = brought_from(x, place + kDigitBits);
  const auto whole = static_cast<std::int64_t>(units);
  const auto rest = static_cast<std::int64_t>((units - static_cast<double>(whole)) * 0x1p62);
  return carried(FixedInt<2>{{rest, whole}});
}

template <>
inline FixedInt<4> scaled_integer<FixedInt<4>>(double x, int place) {
  const RawParts raw(x);
  if (raw.magnitude == 0) return {};
  const int shift = raw.place - place;
  const unsigned up = shift < 0 ? 0U : static_cast<unsigned>(shift);
  const auto first = std::min<std::size_t>(up / kDigitBits, 2);
  const auto magnitude = static_cast<Int128>(
      Uint128{shift < 0 ? raw.magnitude >> -shift : raw.magnitude} << (up - kDigitBits * first));
  const Int128 number = raw.negative ? -magnitude : magnitude;
  FixedInt<4> result;
  result.digit[first] = low_digit(static_cast<std::uint64_t>(number));
  result.digit[first + 1] = static_cast<std::int64_t>((number - result.digit[first]) >> kDigitBits);
  return carried(result);
}

template <>
inline BigInt scaled_integer<BigInt>(double x, int place) {
  const BinaryParts parts = binary_parts(x);
  if (parts.significand == 0) return 0;
  return BigInt(parts.significand) << (parts.exponent - place);
}

/// A significand as an integer that multiplies numbers of the first argument's kind.
template <std::size_t N>
FixedInt<1> integer_like(const FixedInt<N>&, std::int64_t significand) {
  return {{significand}};
}
inline BigInt integer_like(const BigInt&, std::int64_t significand) { return significand; }

}  // namespace pierce::exact
