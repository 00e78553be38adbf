// SPDX-License-Identifier: Apache-2.0
//
// First the plane, then the barycentric coordinates of the point in two dimensions.
// Source: Badouel, "An Efficient Ray-Polygon Intersection", Graphics Gems, 1990.
//
//   N = (B - A) x (C - A),  t = N.(A - O) / N.D,  P = O + t D
//   drop the coordinate in which N is longest: the triangle keeps as much of its area as it can;
//   then, with [pq] the 2D cross product of p and q,
//   u = [(P - A)(C - A)] / [(B - A)(C - A)],   v = [(B - A)(P - A)] / [(B - A)(C - A)]
//
// Cost: 19 multiplications, 3 divisions; 12 and 1 when t is already out of range. Badouel keeps N,
// N.A and the dropped axis with the triangle, which leaves 12 and 3.
//
// What it gets wrong in floating point: as plane_then_edges, P is rounded before it is tested. The
// dropped coordinate no longer matters, so an error across the plane does less harm.
#pragma once

#include <optional>

#include "pierce/textbook/common.h"

namespace pierce::textbook {

template <class Scalar>
std::optional<TextbookHit<Scalar>> plane_then_barycentric(const Ray<Scalar>& ray,
                                                          const Vec3<Scalar>& a,
                                                          const Vec3<Scalar>& b,
                                                          const Vec3<Scalar>& c) {
  const Vec3<Scalar> e1 = b - a, e2 = c - a;
  const Vec3<Scalar> n = cross(e1, e2);
  const Scalar n_d = dot(n, ray.direction);
  if (n_d == 0) return std::nullopt;

  const Scalar t = dot(n, a - ray.origin) / n_d;
  if (!in_range(ray, t)) return std::nullopt;
  const Vec3<Scalar> p = ray.origin + t * ray.direction - a;

  const int dropped = longest_axis(n);
  const int x = dropped == 2 ? 0 : dropped + 1, y = x == 2 ? 0 : x + 1;  // dropped, x, y: cyclic
  const auto cross_2d = [x, y](const Vec3<Scalar>& q, const Vec3<Scalar>& r) -> Scalar {
    return component(q, x) * component(r, y) - component(q, y) * component(r, x);
  };
  const Scalar& area = component(n, dropped);  // = cross_2d(e1, e2)
  const Scalar u = cross_2d(p, e2) / area;
  if (u < 0) return std::nullopt;
  const Scalar v = cross_2d(e1, p) / area;
  if (v < 0 || u + v > 1) return std::nullopt;

  return TextbookHit<Scalar>{t, u, v};
}

}  // namespace pierce::textbook
