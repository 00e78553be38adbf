// SPDX-License-Identifier: Apache-2.0
//
// Crossings by their definition: the origin o is shifted to o + (e, e^2, e^3) with e -> 0, and a
// sign that would be 0 is that of the first term in e that is not.
#pragma once

#include <array>
#include <cmath>

#include "check/exact.h"
#include "pierce/types.h"
#include "pierce/vector.h"

namespace pierce::tool {

/// The sign of x + e s.x + e^2 s.y + e^3 s.z.
inline int shifted_sign(const Exact& x, const Vec3<Exact>& s) {
  for (const Exact* term : {&x, &s.x, &s.y, &s.z}) {
    if (term->sign() != 0) return term->sign();
  }
  return 0;
}

/// +1 if the shifted ray leaves through the triangle, -1 if it enters, 0 if it does neither.
template <class Real>
int passage(const Ray<Real>& ray, const Vec3<Exact>& o, const Vec3<Exact>& d,
            const std::array<Vec3<Exact>, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3<Exact> n = cross(b - a, c - a);
  const int facing = dot(n, d).sign();
  if (facing == 0) return 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3<Exact>&p = corners[i], &q = corners[(i + 1) % 3];
    if (shifted_sign(dot(d, cross(p - o, q - o)), cross(d, q - p)) != facing) return 0;
  }
  const auto beyond = [&](Real end) {  // the sign of t - end
    if (std::isinf(end)) return end > 0 ? -1 : 1;
    const Exact first = dot(n, corners[0] - o) - Exact(static_cast<double>(end)) * dot(n, d);
    return shifted_sign(first, -n) * facing;
  };
  return beyond(ray.t_min) > 0 && beyond(ray.t_max) < 0 ? facing : 0;
}

/// Whether p lies on the segment from a to b, which may be a point.
inline bool on_segment(const Vec3<Exact>& p, const Vec3<Exact>& a, const Vec3<Exact>& b) {
  const Vec3<Exact> n = cross(b - a, p - a);
  return n.x == 0 && n.y == 0 && n.z == 0 && dot(a - p, b - p) <= 0 && (a != b || p == a);
}

/// Whether p lies on the closed triangle, which may have no area.
inline bool on_triangle(const Vec3<Exact>& p, const std::array<Vec3<Exact>, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3<Exact> n = cross(b - a, c - a);
  if (n.x == 0 && n.y == 0 && n.z == 0) {
    return on_segment(p, a, b) || on_segment(p, b, c) || on_segment(p, c, a);
  }
  if (dot(n, p - a) != 0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3<Exact>&q = corners[i], &r = corners[(i + 1) % 3];
    if (dot(n, cross(r - q, p - q)) < 0) return false;
  }
  return true;
}

}  // namespace pierce::tool
