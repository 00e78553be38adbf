// SPDX-License-Identifier: Apache-2.0
//
// From double to float, downward and upward.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace pierce::exact {

/// The next float below a finite one (std::nextafter is a call, and this is done six times for
/// every triangle).
inline float step_down(float f) {
  constexpr std::uint32_t kSign = 0x80000000U;
  const auto bits = std::bit_cast<std::uint32_t>(f);
  if ((bits & ~kSign) == 0) return -std::numeric_limits<float>::denorm_min();
  return std::bit_cast<float>((bits & kSign) == 0 ? bits - 1 : bits + 1);
}

/// The largest float not above x, which must be finite and in the range of floats.
inline float round_down(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? step_down(f) : f;
}

/// The smallest float not below x.
inline float round_up(double x) { return -round_down(-x); }

}  // namespace pierce::exact
