// SPDX-License-Identifier: Apache-2.0
//
// The last step of rounding an exact number: an integer at some power of two, of which it is known
// whether anything is left over, becomes a float or a double.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pierce::exact {

/// The exponent of the least subnormal.
template <class Real>
constexpr int lowest_place() {
  return std::numeric_limits<Real>::min_exponent - std::numeric_limits<Real>::digits;
}

/// (quotient + rest) * 2^place, 0 <= rest < 1, rounded to the nearest Real, ties to even; `more`
/// says that rest is not 0. The quotient holds at least two bits more than are kept and at most 63
/// in all: place <= last place kept - 1.
template <class Real>
Real round_places(std::uint64_t quotient, bool more, int place) {
  using Limits = std::numeric_limits<Real>;
  const int width = static_cast<int>(std::bit_width(quotient));
  const int last = std::max(place + width - Limits::digits, lowest_place<Real>());
  const int drop = last - place;
  const std::uint64_t half = std::uint64_t{1} << (drop - 1);
  const std::uint64_t kept = quotient >> drop;
  const std::uint64_t below = quotient & (2 * half - 1);
  const bool up = below > half || (below == half && (more || (kept & 1U) != 0));
  const double magnitude = std::ldexp(static_cast<double>(kept + (up ? 1 : 0)), last);
  // For float, ldexp is exact in double and the cast is exact or overflows to inf as it should:
  // the value has at most 24 bits, so it is either at most FLT_MAX or at least 2^128.
  return magnitude > static_cast<double>(Limits::max()) ? Limits::infinity()
                                                        : static_cast<Real>(magnitude);
}

}  // namespace pierce::exact
