// SPDX-License-Identifier: Apache-2.0
//
// Doubles that share a power of two, as integers: x = integer * 2^place.
#pragma once

#include <cstddef>
#include <cstdint>

#include "exact/big_int.h"
#include "exact/binary_parts.h"
#include "exact/fixed_int.h"

namespace pierce::exact {

/// How many bits L a coordinate or a direction may have to enter FixedInt<N>. With L = 64 N - 4,
/// what determinants.h makes of them always fits: differences are below 2^(L + 1), minors below
/// 2^(2L + 3) in 128 N - 1 bits, dot products below 2^(3L + 6) and W below 2^(3L + 7) <= 2^(192 N -
/// 5) in 192 N - 1 bits.
template <std::size_t N>
inline constexpr int kCoordinateBits = static_cast<int>(64 * N) - 4;

/// x / 2^place as an integer; place must not be above the lowest bit of x, and x must fit.
template <class Integer>
Integer scaled_integer(double x, int place);

template <>
inline FixedInt<1> scaled_integer<FixedInt<1>>(double x, int place) {
  const RawParts raw(x);
  if (raw.magnitude == 0) return {};
  const int shift = raw.place - place;
  const std::uint64_t magnitude = shift < 0 ? raw.magnitude >> -shift : raw.magnitude << shift;
  return {{raw.negative ? 0 - magnitude : magnitude}};
}

template <>
inline FixedInt<2> scaled_integer<FixedInt<2>>(double x, int place) {
  const BinaryParts parts = binary_parts(x);
  if (parts.significand == 0) return {};
  const FixedInt<1> narrow{{static_cast<std::uint64_t>(parts.significand)}};
  return shifted_left(widened<2>(narrow), static_cast<unsigned>(parts.exponent - place));
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
  return {{static_cast<std::uint64_t>(significand)}};
}
inline BigInt integer_like(const BigInt&, std::int64_t significand) { return significand; }

}  // namespace pierce::exact
