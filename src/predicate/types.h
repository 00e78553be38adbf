// SPDX-License-Identifier: Apache-2.0
//
// What the rungs of the ladder pass along. Float scenes enter here too: a float is a double.
#pragma once

#include <limits>

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

/// Whether it is the same triangle, whichever corner comes first and whichever way it faces.
template <class Triangle>
bool same_corners(const Triangle& p, const Triangle& q) {
  if (p.a == q.a) return (p.b == q.b && p.c == q.c) || (p.b == q.c && p.c == q.b);
  if (p.a == q.b) return (p.b == q.a && p.c == q.c) || (p.b == q.c && p.c == q.a);
  return p.a == q.c && ((p.b == q.a && p.c == q.b) || (p.b == q.b && p.c == q.a));
}

}  // namespace pierce::predicate
