// SPDX-License-Identifier: Apache-2.0
//
// What the rungs of the ladder pass along. Float scenes enter here too: a float is a double.
#pragma once

#include <cstdint>
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

  /// a, b or c.
  [[nodiscard]] const Vec3<double>& corner(int k) const { return k == 0 ? a : k == 1 ? b : c; }
};

/// Which weights of a hit are zero, a bit each. One bit: the point lies on the edge across from
/// that corner; two bits: on a vertex.
inline constexpr std::uint8_t kZeroU = 1;
inline constexpr std::uint8_t kZeroV = 2;
inline constexpr std::uint8_t kZeroW = 4;

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

inline double component(const Vec3<double>& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

inline int sign_of_double(double x) { return (x > 0 ? 1 : 0) - (x < 0 ? 1 : 0); }

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

/// The corners (0, 1, 2 for a, b, c) whose weights are not known to be zero: how many there are,
/// and the first and the last of them.
struct Support {
  std::uint8_t count, first, last;
};
/// By the zeros.
inline constexpr Support kSupports[8] = {{3, 0, 2}, {2, 0, 2}, {2, 0, 1}, {1, 0, 0},
                                         {2, 1, 2}, {1, 2, 2}, {1, 1, 1}, {0, 0, 0}};

/// Whether a triangle has these corners of another one.
inline bool has_corners(const TriangleD& t, const TriangleD& of, Support support) {
  const auto has = [&t](const Vec3<double>& p) { return t.a == p || t.b == p || t.c == p; };
  return has(of.corner(support.first)) && has(of.corner(support.last));
}

/// Whether two hits of a ray, in which these weights are known to be zero, lie in the same corner
/// or on the same edge: the ray lies in neither plane, so it meets the edge's line in one point
/// only, and both t are the t of that point. `p(k)` is corner k of the first triangle.
template <class Corner>
bool meet_in_shared_feature(const Corner& p, std::uint8_t p_zeros, const Corner& q,
                            std::uint8_t q_zeros) {
  const Support i = kSupports[p_zeros], j = kSupports[q_zeros];
  if (i.count == 3 || i.count != j.count) return false;
  if (i.count == 1) return p(i.first) == q(j.first);
  return (p(i.first) == q(j.first) && p(i.last) == q(j.last)) ||
         (p(i.first) == q(j.last) && p(i.last) == q(j.first));
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
