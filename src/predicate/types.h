// SPDX-License-Identifier: Apache-2.0
//
// What the rungs of the ladder pass along. Float scenes enter here too: a float is a double.
#pragma once

#include <limits>
#include <type_traits>

#include "pierce/types.h"

namespace pierce::predicate {

struct RayD {
  Vec3<double> origin, direction;
  double t_min = 0;
  double t_max = std::numeric_limits<double>::infinity();
  bool open_start = false;  // t = t_min does not count
};

struct TriangleD {
  Vec3<double> a, b, c;
};

/// An answer that may be "don't know". Only a sure one may be read.
enum class Certified : unsigned char { No, Yes, Unsure };

inline Certified certified(bool yes) { return yes ? Certified::Yes : Certified::No; }

template <class Real>
Vec3<double> to_double(const Vec3<Real>& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

template <class Real>
RayD to_double(const Ray<Real>& ray, Range range) {
  return {to_double(ray.origin), to_double(ray.direction), static_cast<double>(ray.t_min),
          static_cast<double>(ray.t_max), range == Range::OpenStart};
}

/// The axes, as bits 1, 2, 4, across which the triangle stands: where its corners have the same
/// coordinate.
inline unsigned axes_across(const TriangleD& t) {
  return (t.a.x == t.b.x && t.a.x == t.c.x ? 1U : 0U) |
         (t.a.y == t.b.y && t.a.y == t.c.y ? 2U : 0U) |
         (t.a.z == t.b.z && t.a.z == t.c.z ? 4U : 0U);
}
/// The axes along which the ray does not move.
template <class Real>
unsigned still_axes(const Vec3<Real>& direction) {
  return (direction.x == 0 ? 1U : 0U) | (direction.y == 0 ? 2U : 0U) | (direction.z == 0 ? 4U : 0U);
}

/// Whether it is the same triangle, whichever corner comes first and whichever way it faces.
template <class Triangle>
bool same_corners(const Triangle& p, const Triangle& q) {
  if (p.a == q.a) return (p.b == q.b && p.c == q.c) || (p.b == q.c && p.c == q.b);
  if (p.a == q.b) return (p.b == q.a && p.c == q.c) || (p.b == q.c && p.c == q.a);
  return p.a == q.c && ((p.b == q.a && p.c == q.b) || (p.b == q.b && p.c == q.a));
}

/// Whether both lie in one plane that stands across an axis. A ray that hits them does so where it
/// meets that plane.
template <class Triangle>
bool share_plane_across_axis(const Triangle& p, const Triangle& q) {
  const auto share = [&](auto axis) {
    const auto place = p.a.*axis;
    return p.b.*axis == place && p.c.*axis == place && q.a.*axis == place && q.b.*axis == place &&
           q.c.*axis == place;
  };
  using Corner = std::remove_cvref_t<decltype(p.a)>;
  return share(&Corner::x) || share(&Corner::y) || share(&Corner::z);
}

}  // namespace pierce::predicate
