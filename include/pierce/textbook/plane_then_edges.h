// SPDX-License-Identifier: Apache-2.0
//
// First the plane, then on which side of every edge the point lies: the geometric solution that
// most introductions start with, and the only one here that works for any planar convex polygon.
// Source: older than computers; in ray tracing, Snyder and Barr, "Ray Tracing Complex Models
// Containing Surface Tessellations", SIGGRAPH 1987; Haines in Glassner (ed.), "An Introduction to
// Ray Tracing", 1989.
//
//   N = (B - A) x (C - A)
//   t = N.(A - O) / N.D               where the ray meets the plane (parallel if N.D = 0)
//   P = O + t D
//   N.((B - A) x (P - A)) >= 0        P is on the inner side of AB; and so for BC and CA
//
//   The three side values are N.N times w', u', v': areas over the whole area are the barycentric
//   coordinates (that of a corner belongs to the edge opposite).
//
// Cost: 45 multiplications, 3 divisions for a triangle; 12 and 1 when t is already out of range.
// Nothing kept.
//
// What it gets wrong in floating point: P is rounded before it is tested, so it lies beside the
// plane and beside the ray; for a nearly parallel ray by far. A point that truly is outside can be
// moved in (a false hit), one on an edge can be moved out of both triangles that share it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include "pierce/textbook/common.h"

namespace pierce::textbook {

template <class Scalar>
std::optional<TextbookHit<Scalar>> plane_then_edges(const Ray<Scalar>& ray, const Vec3<Scalar>& a,
                                                    const Vec3<Scalar>& b, const Vec3<Scalar>& c) {
  const Vec3<Scalar> n = cross(b - a, c - a);
  const Scalar n_d = dot(n, ray.direction);
  if (n_d == 0) return std::nullopt;

  const Scalar t = dot(n, a - ray.origin) / n_d;
  if (!in_range(ray, t)) return std::nullopt;
  const Vec3<Scalar> p = ray.origin + t * ray.direction;

  const Scalar side_ab = dot(n, cross(b - a, p - a));
  if (side_ab < 0) return std::nullopt;
  const Scalar side_bc = dot(n, cross(c - b, p - b));
  if (side_bc < 0) return std::nullopt;
  const Scalar side_ca = dot(n, cross(a - c, p - c));
  if (side_ca < 0) return std::nullopt;

  const Scalar n_n = dot(n, n);
  return TextbookHit<Scalar>{t, side_ca / n_n, side_ab / n_n};
}

/// The vector area of a planar polygon: its area times its unit normal, doubled.
template <class Scalar>
Vec3<Scalar> vector_area(std::span<const Vec3<Scalar>> corners) {
  Vec3<Scalar> n = {0, 0, 0};
  for (std::size_t i = 2; i < corners.size(); ++i) {
    n = n + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  }
  return n;
}

/// The same for a planar convex polygon, its corners in order (either way round, at least three,
/// edges of length 0 and straight corners welcome): the t at which the ray meets it, edges and
/// corners included. N is the polygon's vector area, so no three corners are special. Corners that
/// are not in one plane are taken to be: the plane through the first, with that N.
template <class Scalar>
std::optional<Scalar> plane_then_edges(
    const Ray<Scalar>& ray, std::type_identity_t<std::span<const Vec3<Scalar>>> corners) {
  const Vec3<Scalar> n = vector_area<Scalar>(corners);
  const Scalar n_d = dot(n, ray.direction);
  if (n_d == 0) return std::nullopt;

  const Scalar t = dot(n, corners[0] - ray.origin) / n_d;
  if (!in_range(ray, t)) return std::nullopt;
  const Vec3<Scalar> p = ray.origin + t * ray.direction;

  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3<Scalar>& from = corners[i];
    const Vec3<Scalar>& to = corners[i + 1 < corners.size() ? i + 1 : 0];
    const Scalar side = dot(n, cross(to - from, p - from));
    if (side < 0) return std::nullopt;
  }
  return t;
}

}  // namespace pierce::textbook
