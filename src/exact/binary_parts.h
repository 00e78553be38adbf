// SPDX-License-Identifier: Apache-2.0
//
// A double taken apart: odd integer times a power of two. The start of every exact rung.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace pierce::exact {

struct BinaryParts {
  std::int64_t significand;  // odd, or 0 for zero; at most 53 bits
  int exponent;              // value = significand * 2^exponent; 0 for zero
};

/// A double as its bits have it: magnitude * 2^place, with zeros at the end perhaps.
struct RawParts {
  std::uint64_t magnitude;
  int place;
  bool negative;

  /// Exact for every finite double, subnormal or not.
  explicit RawParts(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t fraction = bits & 0xfffffffffffffU;
    const int biased = static_cast<int>((bits >> 52) & 0x7ffU);
    magnitude = biased == 0 ? fraction : fraction | (std::uint64_t{1} << 52);
    place = std::max(biased, 1) - 1075;
    negative = (bits >> 63) != 0;
  }
};

/// 2^exponent, which must be a normal number.
inline double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

inline BinaryParts binary_parts(double x) {
  const RawParts raw(x);
  if (raw.magnitude == 0) return {0, 0};
  const int zeros = std::countr_zero(raw.magnitude);
  const auto significand = static_cast<std::int64_t>(raw.magnitude >> zeros);
  return {raw.negative ? -significand : significand, raw.place + zeros};
}

/// The powers of two between which the bits of some numbers lie.
struct BitSpan {
  int low = 1 << 20;      // no bit is below 2^low
  int high = -(1 << 20);  // every magnitude is below 2^high

  void include(double x) {
    const RawParts raw(x);
    if (raw.magnitude == 0) return;
    low = std::min(low, raw.place + std::countr_zero(raw.magnitude));
    high = std::max(high, raw.place + static_cast<int>(std::bit_width(raw.magnitude)));
  }

  [[nodiscard]] bool empty() const { return low > high; }
  [[nodiscard]] int width() const { return empty() ? 0 : high - low; }
};

}  // namespace pierce::exact
