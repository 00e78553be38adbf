// SPDX-License-Identifier: Apache-2.0
//
// About the nearest point of a triangle, in doubles. Whichever point of it that is, it makes bounds
// on the distance (kernels/points/nearest.h): so it does not matter how badly it is computed.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pierce/types.h"
#include "pierce/vector.h"

namespace pierce::predicate {

inline double max_norm(const Vec3<double>& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// The vector from the point to about the nearest point of the triangle, whose corners it sees at
/// a, b, c: the best of the nearest points of its edges, and of the foot of the perpendicular where
/// that is inside. (a + v e1 + w e2 for some v, w >= 0, v + w <= 1, up to rounding.)
inline Vec3<double> towards_triangle(const Vec3<double>& a, const Vec3<double>& b,
                                     const Vec3<double>& c) {
  const auto share = [](double part, double all) {
    return all > 0 ? std::clamp(part / all, 0.0, 1.0) : 0.0;
  };
  const Vec3<double> e1 = b - a;
  const Vec3<double> e2 = c - a;
  const double a_e1 = -dot(a, e1);
  const double a_e2 = -dot(a, e2);
  const double e11 = dot(e1, e1);
  const double e12 = dot(e1, e2);
  const double e22 = dot(e2, e2);
  const double area = e11 * e22 - e12 * e12;
  const double v = (e22 * a_e1 - e12 * a_e2) / area;
  const double w = (e11 * a_e2 - e12 * a_e1) / area;
  const auto at = [&](double x, double y) {
    return Vec3<double>{a.x + x * e1.x + y * e2.x, a.y + x * e1.y + y * e2.y,
                        a.z + x * e1.z + y * e2.z};
  };
  if (v > 0 && w > 0 && v + w < 1) return at(v, w);
  const double on_bc = share(a_e2 - a_e1 - e12 + e11, e11 - 2 * e12 + e22);
  const Vec3<double> edges[] = {at(share(a_e1, e11), 0), at(0, share(a_e2, e22)),
                                at(1 - on_bc, on_bc)};
  return *std::min_element(std::begin(edges), std::end(edges),
                           [](const auto& p, const auto& q) { return dot(p, p) < dot(q, q); });
}

}  // namespace pierce::predicate
