// SPDX-License-Identifier: Apache-2.0
//
// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", Journal of Computer Graphics
// Techniques 2(1), 2013: move and shear space so that the ray becomes the z axis, then ask in two
// dimensions whether the origin lies in the triangle.
//
//   kz: the axis in which d is longest; kx, ky the other two, swapped if d_kz < 0
//   Sx = d_kx / d_kz,  Sy = d_ky / d_kz,  Sz = 1 / d_kz                        (kept with the ray)
//
//   A = a - o, then Ax = A_kx - Sx A_kz, Ay = A_ky - Sy A_kz; B and C the same
//   U = Cx By - Cy Bx,  V = Ax Cy - Ay Cx,  W = Bx Ay - By Ax       all >= 0 or all <= 0, or no hit
//   det = U + V + W
//   T = U (Sz A_kz) + V (Sz B_kz) + W (Sz C_kz),  t = T / det
//
//   U, V, W belong to a, b, c: the weights of b and c, our u and v, are V / det and W / det.
//
// Cost: 21 multiplications, 1 division (12 and none for a miss). Kept with the ray: 3 axes, 3
// numbers, 3 divisions once.
//
// What it gets right: an edge's U depends only on its two ends, and swapping them flips its sign
// exactly, so the two triangles at an edge never disagree: no ray slips between them. A U of 0 that
// rounding may have made is computed again in the next wider type.
//
// What it gets wrong in floating point: the shear rounds every vertex, so it is exact about a
// slightly moved mesh: a ray near an edge can be given to the wrong neighbour, one near the rim of
// a mesh called either way. A product of two tiny numbers can underflow to 0. t is as rounded as
// elsewhere: of two triangles at nearly the same t, the wrong one can win.
#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "pierce/textbook/common.h"

namespace pierce::textbook {

/// What is kept with a ray. Valid as long as the ray lives.
template <class Scalar>
struct ShearedRay {
  const Ray<Scalar>& ray;
  int kx, ky, kz;
  Scalar sx, sy, sz;

  explicit ShearedRay(const Ray<Scalar>& the_ray)
      : ray(the_ray),
        kx(0),
        ky(0),
        kz(longest_axis(ray.direction)),
        sx(0),
        sy(0),
        sz(1 / component(ray.direction, kz)) {
    kx = kz == 2 ? 0 : kz + 1;
    ky = kx == 2 ? 0 : kx + 1;
    if (component(ray.direction, kz) < 0) std::swap(kx, ky);  // keeps the winding
    sx = component(ray.direction, kx) / component(ray.direction, kz);
    sy = component(ray.direction, ky) / component(ray.direction, kz);
  }
};

/// The next wider type, for edge functions that came out 0; exact types need none.
template <class Scalar>
using Wider =
    std::conditional_t<std::is_same_v<Scalar, float>, double,
                       std::conditional_t<std::is_same_v<Scalar, double>, long double, Scalar>>;

template <class Scalar>
std::optional<TextbookHit<Scalar>> watertight(const ShearedRay<Scalar>& sheared,
                                              const Vec3<Scalar>& corner_a,
                                              const Vec3<Scalar>& corner_b,
                                              const Vec3<Scalar>& corner_c) {
  const auto& [ray, kx, ky, kz, sx, sy, sz] = sheared;
  const Vec3<Scalar> a = corner_a - ray.origin;
  const Vec3<Scalar> b = corner_b - ray.origin;
  const Vec3<Scalar> c = corner_c - ray.origin;

  const Scalar ax = component(a, kx) - sx * component(a, kz);
  const Scalar ay = component(a, ky) - sy * component(a, kz);
  const Scalar bx = component(b, kx) - sx * component(b, kz);
  const Scalar by = component(b, ky) - sy * component(b, kz);
  const Scalar cx = component(c, kx) - sx * component(c, kz);
  const Scalar cy = component(c, ky) - sy * component(c, kz);

  Scalar u = cx * by - cy * bx;
  Scalar v = ax * cy - ay * cx;
  Scalar w = bx * ay - by * ax;
  if constexpr (!std::is_same_v<Wider<Scalar>, Scalar>) {
    if (u == 0 || v == 0 || w == 0) {
      using Wide = Wider<Scalar>;
      u = static_cast<Scalar>(Wide(cx) * Wide(by) - Wide(cy) * Wide(bx));
      v = static_cast<Scalar>(Wide(ax) * Wide(cy) - Wide(ay) * Wide(cx));
      w = static_cast<Scalar>(Wide(bx) * Wide(ay) - Wide(by) * Wide(ax));
    }
  }
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;

  const Scalar det = u + v + w;
  if (det == 0) return std::nullopt;

  const Scalar az = sz * component(a, kz), bz = sz * component(b, kz), cz = sz * component(c, kz);
  const Scalar f = 1 / det;
  const Scalar t = (u * az + v * bz + w * cz) * f;
  if (!in_range(ray, t)) return std::nullopt;
  return TextbookHit<Scalar>{t, v * f, w * f};
}

/// The common signature: nothing kept.
template <class Scalar>
std::optional<TextbookHit<Scalar>> watertight(const Ray<Scalar>& ray, const Vec3<Scalar>& a,
                                              const Vec3<Scalar>& b, const Vec3<Scalar>& c) {
  return watertight(ShearedRay<Scalar>(ray), a, b, c);
}

}  // namespace pierce::textbook
