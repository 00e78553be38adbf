// SPDX-License-Identifier: Apache-2.0
//
// Baldwin and Weber, "Fast Ray-Triangle Intersections by Coordinate Transformation", Journal of
// Computer Graphics Techniques 5(3), 2016: keep with each triangle the affine map that takes it to
// the triangle (0,0,0), (1,0,0), (0,1,0) in the plane z = 0.
//
//   The third axis of the map is free. Taken along the coordinate axis k in which N = e1 x e2 is
//   longest, it makes a third of the map's numbers 0 or 1. With i, j following k cyclically:
//
//   u(p) = ( e2_j p_i - e2_i p_j)/N_k + const        v(p) = (-e1_j p_i + e1_i p_j)/N_k + const
//   z(p) = p_k + (N_i p_i + N_j p_j)/N_k + const     each const such that u(a) = v(a) = z(a) = 0
//
//   t = -z(o) / (z(d) without its const),  u = u(o + t d),  v = v(o + t d)
//
// Cost: 10 multiplications, 1 division (4 and 1 when t is already out of range). Kept with the
// triangle: 9 numbers and an axis instead of its 9 coordinates, 12 multiplications and 6 divisions
// once.
//
// What it gets wrong in floating point: the map is rounded once and for all, so the triangle that
// is tested is not quite the one given, and at an edge it is a different one for each of the two
// triangles: cracks and overlaps. Far from the coordinate origin the consts are large and cancel.
#pragma once

#include <array>
#include <optional>

#include "pierce/textbook/common.h"

namespace pierce::textbook {

/// What is kept with a triangle.
template <class Scalar>
struct AffineTriangle {
  int k = 0;                      ///< the free axis; -1: a triangle without area
  std::array<Scalar, 3> u, v, z;  ///< factor of p_i, factor of p_j, const

  AffineTriangle(const Vec3<Scalar>& a, const Vec3<Scalar>& b, const Vec3<Scalar>& c) {
    const Vec3<Scalar> e1 = b - a, e2 = c - a;
    const Vec3<Scalar> n = cross(e1, e2);
    k = longest_axis(n);
    const int i = next(k), j = next(i);
    const Scalar& nk = component(n, k);
    if (nk == 0) {
      k = -1;
      return;
    }
    u = {component(e2, j) / nk, -component(e2, i) / nk, 0};
    v = {-component(e1, j) / nk, component(e1, i) / nk, 0};
    z = {component(n, i) / nk, component(n, j) / nk, 0};
    u[2] = -(u[0] * component(a, i) + u[1] * component(a, j));
    v[2] = -(v[0] * component(a, i) + v[1] * component(a, j));
    z[2] = -(component(a, k) + z[0] * component(a, i) + z[1] * component(a, j));
  }

  static constexpr int next(int axis) { return axis == 2 ? 0 : axis + 1; }
};

template <class Scalar>
std::optional<TextbookHit<Scalar>> baldwin_weber(const Ray<Scalar>& ray,
                                                 const AffineTriangle<Scalar>& triangle) {
  const auto& [k, to_u, to_v, to_z] = triangle;
  if (k < 0) return std::nullopt;
  const int i = triangle.next(k), j = triangle.next(i);
  const Vec3<Scalar>&o = ray.origin, &d = ray.direction;

  const Scalar z_d = component(d, k) + to_z[0] * component(d, i) + to_z[1] * component(d, j);
  if (z_d == 0) return std::nullopt;
  const Scalar z_o =
      component(o, k) + to_z[0] * component(o, i) + to_z[1] * component(o, j) + to_z[2];
  const Scalar t = -z_o / z_d;
  if (!in_range(ray, t)) return std::nullopt;

  const Scalar pi = component(o, i) + t * component(d, i);
  const Scalar pj = component(o, j) + t * component(d, j);
  const Scalar u = to_u[0] * pi + to_u[1] * pj + to_u[2];
  if (u < 0 || u > 1) return std::nullopt;
  const Scalar v = to_v[0] * pi + to_v[1] * pj + to_v[2];
  if (v < 0 || u + v > 1) return std::nullopt;

  return TextbookHit<Scalar>{t, u, v};
}

/// The common signature: nothing kept.
template <class Scalar>
std::optional<TextbookHit<Scalar>> baldwin_weber(const Ray<Scalar>& ray, const Vec3<Scalar>& a,
                                                 const Vec3<Scalar>& b, const Vec3<Scalar>& c) {
  return baldwin_weber(ray, AffineTriangle<Scalar>(a, b, c));
}

}  // namespace pierce::textbook
