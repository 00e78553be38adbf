// SPDX-License-Identifier: Apache-2.0
//
// Points spread evenly and without chance: the R2 sequence (M. Roberts, "The unreasonable
// effectiveness of quasirandom sequences", 2018), shifted by a hash so that neighbouring pixels
// do not see the same points. The same seed gives the same picture on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "pierce/vector.h"

namespace pierce::tool {

/// A hash whose every output bit depends on every input bit (the finaliser of SplitMix64).
[[nodiscard]] inline std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

struct Point2 {
  double x, y;  ///< in [0, 1)
};

/// Point `index` of the sequence, shifted (and wrapped round) by what `key` hashes to.
[[nodiscard]] inline Point2 spread_point(std::uint64_t index, std::uint64_t key) {
  // 1/g and 1/g^2 with g^3 = g + 1, as fractions of 2^64: wrapping round is integer overflow.
  constexpr std::uint64_t kX = 0xc13fa9a902a6328fU, kY = 0x91e10da5c79e7b1cU;
  const std::uint64_t shift = mix(key);
  const std::uint64_t x = (index + 1) * kX + shift;
  const std::uint64_t y = (index + 1) * kY + mix(shift);
  return {static_cast<double>(x >> 11U) * 0x1p-53, static_cast<double>(y >> 11U) * 0x1p-53};
}

/// A direction on the hemisphere about the unit vector `n`, with density proportional to the
/// cosine.
[[nodiscard]] inline Vec3<double> cosine_direction(const Vec3<double>& n, Point2 p) {
  // Two vectors that make an orthonormal base with n (Duff et al. 2017).
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z), b = n.x * n.y * a;
  const Vec3<double> s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  const Vec3<double> t = {b, sign + n.y * n.y * a, -n.y};

  const double radius = std::sqrt(p.x), angle = 2 * std::numbers::pi * p.y;
  return radius * std::cos(angle) * s + radius * std::sin(angle) * t + std::sqrt(1 - p.x) * n;
}

}  // namespace pierce::tool
