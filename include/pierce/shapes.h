// SPDX-License-Identifier: Apache-2.0
//
// A ray with other shapes: plane, sphere, planar polygon, and a single triangle, all asked in one
// way: `intersect(shape, ray)` gives the first hit in the range of the ray, or nothing. Found by
// argument-dependent lookup, so a caller's own shape joins in by having such a function beside it.
//
// Any scalar type; the sphere needs a square root, so a floating one. Over an exact rational the
// answers are exact. Over floats they are rounded, but for the triangle, which is decided exactly.
// Surfaces are closed sets (boundaries belong to them); a ray in the plane of a flat shape never
// hits it. Pure functions; no allocation for built-in types.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "pierce/intersect.h"
#include "pierce/textbook/common.h"
#include "pierce/textbook/determinants.h"
#include "pierce/textbook/plane_then_edges.h"

namespace pierce::shapes {

/// The first point of the ray on a surface, and the surface's normal there (not of unit length).
template <class Scalar>
struct SurfaceHit {
  Scalar t;
  Vec3<Scalar> normal;
};

template <class Scalar>
Vec3<Scalar> point_at(const Ray<Scalar>& ray, const Scalar& t) {
  return ray.origin + t * ray.direction;
}

/// All points p with (p - point) . normal = 0. The normal must not be 0; it is that of every hit.
template <class Scalar>
struct Plane {
  Vec3<Scalar> point, normal;
};

/// Centre and radius >= 0. The normal of a hit points outwards, also for a ray from inside.
template <class Scalar>
struct Sphere {
  Vec3<Scalar> centre;
  Scalar radius;
};

/// Corners of a planar convex polygon in order, either way round. The normal of a hit is the
/// vector area, for which the corners run counter-clockwise. The corners stay the caller's.
template <class Scalar>
struct ConvexPolygon {
  std::span<const Vec3<Scalar>> corners;
};

/// The same for any simple polygon (one that does not cross itself), convex or not.
template <class Scalar>
struct Polygon {
  std::span<const Vec3<Scalar>> corners;
};

/// A triangle by its corners; the normal of a hit is (b - a) x (c - a). In float and double this is
/// pierce::intersect: exact, correctly rounded, and it throws for numbers that are not finite.
template <class Scalar>
struct Triangle {
  Vec3<Scalar> a, b, c;
};

template <class Scalar>
using Shape = std::variant<Plane<Scalar>, Sphere<Scalar>, ConvexPolygon<Scalar>, Polygon<Scalar>,
                           Triangle<Scalar>>;

/// t = n.(point - o) / n.d
template <class Scalar>
std::optional<SurfaceHit<Scalar>> intersect(const Plane<Scalar>& plane, const Ray<Scalar>& ray) {
  const Scalar n_d = dot(plane.normal, ray.direction);
  if (n_d == 0) return std::nullopt;
  const Scalar t = dot(plane.normal, plane.point - ray.origin) / n_d;
  if (!in_range(ray, t)) return std::nullopt;
  return SurfaceHit<Scalar>{t, plane.normal};
}

namespace detail {

/// A power of two that brings the greatest of these magnitudes to about 1; 1 for numbers that do
/// not overflow.
template <class Scalar>
Scalar inverse_unit(const Vec3<Scalar>& v, const Scalar& x) {
  if constexpr (std::is_floating_point_v<Scalar>) {
    using Limits = std::numeric_limits<Scalar>;
    const Scalar most =
        std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::max(std::fabs(v.z), std::fabs(x)));
    if (!(most > 0) || !(most <= Limits::max())) return 1;
    const int exponent = -std::ilogb(most);
    return std::ldexp(Scalar(1),
                      std::clamp(exponent, Limits::min_exponent, Limits::max_exponent - 1));
  } else {
    return Scalar(1);
  }
}

}  // namespace detail

/// Solves |o + t d - centre|^2 = r^2 without the two cancellations of the schoolbook formula, after
/// Haines, Gunther and Akenine-Moller, "Precision Improvements for Ray/Sphere Intersection", Ray
/// Tracing Gems, 2019: with f = o - centre, a = d.d, b = -f.d, c = f.f - r^2,
///   discriminant = a (r^2 - |f + (b/a) d|^2)       by the ray's distance from the centre
///   q = b + sign(b) sqrt(discriminant),  t = c/q and q/a       no difference of like numbers
/// All of it in units of powers of two near the greatest length, and of the chord's own, so that no
/// square over- or underflows. Spheres far away and of any size: t is off by at most 3.1 ulp of the
/// centre's distance (measured 2026-11), where the schoolbook formula is off by millions.
template <class Scalar>
std::optional<SurfaceHit<Scalar>> intersect(const Sphere<Scalar>& sphere, const Ray<Scalar>& ray) {
  using std::sqrt;
  const Vec3<Scalar> from_centre = ray.origin - sphere.centre;
  const Scalar length = detail::inverse_unit(from_centre, sphere.radius);
  const Scalar size = detail::inverse_unit(ray.direction, Scalar(0));
  const Vec3<Scalar> d = size * ray.direction;
  const Vec3<Scalar> f = length * from_centre;
  const Scalar r = length * sphere.radius;
  const Scalar a = dot(d, d);
  const Scalar b = -dot(f, d);
  const Vec3<Scalar> nearest = f + Scalar(b / a) * d;  // of the line to the centre
  const Scalar finer = detail::inverse_unit(nearest, r);
  const Scalar own_r = finer * r;
  const Vec3<Scalar> own_nearest = finer * nearest;
  const Scalar half_chord_2 = own_r * own_r - dot(own_nearest, own_nearest);
  if (half_chord_2 < 0) return std::nullopt;

  const Scalar root = Scalar(sqrt(Scalar(a * half_chord_2))) / finer;
  const Scalar q = b < 0 ? Scalar(b - root) : Scalar(b + root);
  Scalar first = q / a;
  Scalar second = q == 0 ? first : Scalar((dot(f, f) - r * r) / q);  // q = 0: a touch at t = 0
  if (second < first) std::swap(first, second);
  for (const Scalar& tau : {first, second}) {
    const Scalar t = tau / length * size;
    if (in_range(ray, t)) return SurfaceHit<Scalar>{t, from_centre + t * ray.direction};
  }
  return std::nullopt;
}

template <class Scalar>
std::optional<SurfaceHit<Scalar>> intersect(const Triangle<Scalar>& triangle,
                                            const Ray<Scalar>& ray) {
  const auto& [a, b, c] = triangle;
  if constexpr (std::is_same_v<Scalar, float> || std::is_same_v<Scalar, double>) {
    const auto hit = pierce::intersect(ray, a, b, c);
    if (!hit) return std::nullopt;
    return SurfaceHit<Scalar>{hit->t, cross(b - a, c - a)};
  } else {
    const auto hit = textbook::determinants(ray, a, b, c);
    if (!hit) return std::nullopt;
    return SurfaceHit<Scalar>{hit->t, cross(b - a, c - a)};
  }
}

template <class Scalar>
std::optional<SurfaceHit<Scalar>> intersect(const ConvexPolygon<Scalar>& polygon,
                                            const Ray<Scalar>& ray) {
  const std::optional<Scalar> t = textbook::plane_then_edges(ray, polygon.corners);
  if (!t) return std::nullopt;
  return SurfaceHit<Scalar>{*t, textbook::vector_area<Scalar>(polygon.corners)};
}

/// The plane first; then, seen along the axis in which the normal is longest, the number of edges
/// that a half-line from the point crosses is odd inside (Shimrat 1962; Haines, "Point in Polygon
/// Strategies", Graphics Gems IV, 1994). A point exactly on an edge is found before that.
template <class Scalar>
std::optional<SurfaceHit<Scalar>> intersect(const Polygon<Scalar>& polygon,
                                            const Ray<Scalar>& ray) {
  const auto& corners = polygon.corners;
  const Vec3<Scalar> n = textbook::vector_area<Scalar>(corners);
  if (n == Vec3<Scalar>{0, 0, 0}) return std::nullopt;
  const auto hit = intersect(Plane<Scalar>{corners[0], n}, ray);
  if (!hit) return std::nullopt;
  const Vec3<Scalar> p = point_at(ray, hit->t);

  const int dropped = longest_axis(n);
  const int x = dropped == 2 ? 0 : dropped + 1, y = x == 2 ? 0 : x + 1;
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3<Scalar> from = corners[i] - p;
    const Vec3<Scalar> to = corners[i + 1 < corners.size() ? i + 1 : 0] - p;
    const Scalar &from_x = component(from, x), &from_y = component(from, y);
    const Scalar &to_x = component(to, x), &to_y = component(to, y);
    const Scalar side = from_x * to_y - from_y * to_x;
    const Scalar between = from_x * to_x + from_y * to_y;
    if (side == 0 && between <= 0) return hit;
    if ((from_y > 0) != (to_y > 0) && (side > 0) == (to_y > from_y)) inside = !inside;
  }
  if (!inside) return std::nullopt;
  return hit;
}

template <class Scalar>
std::optional<SurfaceHit<Scalar>> intersect(const Shape<Scalar>& shape, const Ray<Scalar>& ray) {
  return std::visit([&ray](const auto& one) { return intersect(one, ray); }, shape);
}

}  // namespace pierce::shapes
