// SPDX-License-Identifier: Apache-2.0
//
// Four determinants of columns: Cramer's rule (1750) as it stands, nothing shared.
//
//   S + t Q = P0 + u (P1 - P0) + v (P2 - P0), with the ray's start S and direction Q
//
//   A = -Q,  B = P1 - P0,  C = P2 - P0,  D = S - P0:      t A + u B + v C = D
//
//   D0 = |A B C|   t = |D B C| / D0   u = |A D C| / D0   v = |A B D| / D0
//
// Cost: 36 multiplications, 3 divisions; 18 and 1 when t is already out of range. Nothing kept.
//
// What it gets wrong in floating point: the same as cramer, with other roundings. It is the form
// to remember, and the one whose symmetry shows what t, u and v are: ratios of volumes. Two
// triangles that start at the same corner never both lose a ray at the edge they share there: Du of
// one is exactly -Dv of the other. From other corners they do.
#pragma once

#include <optional>

#include "pierce/textbook/common.h"

namespace pierce::textbook {

/// |x y z|, the signed volume that three columns span: 9 multiplications.
template <class Scalar>
Scalar determinant(const Vec3<Scalar>& x, const Vec3<Scalar>& y, const Vec3<Scalar>& z) {
  return dot(x, cross(y, z));
}

/// Tests in this order: parallel (D0 = 0), t in range, u, v.
template <class Scalar>
std::optional<TextbookHit<Scalar>> determinants(const Ray<Scalar>& ray, const Vec3<Scalar>& p0,
                                                const Vec3<Scalar>& p1, const Vec3<Scalar>& p2) {
  const Vec3<Scalar> a = -ray.direction, b = p1 - p0, c = p2 - p0, d = ray.origin - p0;

  const Scalar d0 = determinant(a, b, c);
  if (d0 == 0) return std::nullopt;

  const Scalar dt = determinant(d, b, c);
  const Scalar t = dt / d0;
  if (!in_range(ray, t)) return std::nullopt;

  const Scalar du = determinant(a, d, c);
  const Scalar u = du / d0;
  if (u < 0 || u > 1) return std::nullopt;

  const Scalar dv = determinant(a, b, d);
  const Scalar v = dv / d0;
  if (v < 0 || u + v > 1) return std::nullopt;

  return TextbookHit<Scalar>{t, u, v};
}

}  // namespace pierce::textbook
