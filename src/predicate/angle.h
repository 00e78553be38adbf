// SPDX-License-Identifier: Apache-2.0
//
// The angle of a vector in the plane, by operations that give the same bits everywhere (those of a
// mathematics library do not).
#pragma once

#include <cmath>
#include <numbers>

namespace pierce::predicate {

/// The angle of (x, y), in radians, above -pi and at most pi, within 2^-48. Not for (0, 0), nor
/// for numbers whose squares overflow. An y of -0 is 0.
inline double angle_of(double x, double y) {
  const double across = std::fabs(x), up = y < 0 ? -y : y;
  const bool steep = up > across;
  double t = steep ? across / up : up / across;
  // Three times half the angle: at most pi / 32, where the series has lost all but 2^-57 of it.
  for (int i = 0; i < 3; ++i) t = t / (1 + std::sqrt(1 + t * t));
  const double s = t * t;
  double sum = 1.0 / 15;
  for (int k = 13; k > 0; k -= 2) sum = 1.0 / k - s * sum;
  double angle = 8 * (t * sum);
  if (steep) angle = std::numbers::pi / 2 - angle;
  if (x < 0) angle = std::numbers::pi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace pierce::predicate
