// SPDX-License-Identifier: Apache-2.0
//
// Rays at the hard places of a whole mesh: from vertices, faces and afar, through vertices, edges
// and faces, along edges and in faces, with ranges that end at hits.
#pragma once

#include <cstdint>
#include <vector>

#include "pierce/types.h"
#include "support/hard_cases.h"
#include "support/meshes.h"

namespace pierce::hard {

template <class Real>
struct AimedRay {
  Ray<Real> ray;
  Range range;
  std::uint32_t triangle;  // the one aimed at
};

/// The ray, which goes where it likes.
template <class Real>
AimedRay<Real> with_any_range(Rng& rng, const Mesh<Real>& mesh, const Ray<Real>& ray) {
  const Range range = rng.coin() ? Range::Closed : Range::OpenStart;
  return {ray, range, static_cast<std::uint32_t>(rng.below(mesh.triangles.size()))};
}

/// The mesh has a triangle; `style` is the style of its numbers.
template <class Real>
AimedRay<Real> aimed_ray(Rng& rng, const Mesh<Real>& mesh, Style style) {
  const auto any_triangle = [&] {
    return static_cast<std::uint32_t>(rng.below(mesh.triangles.size()));
  };
  for (;;) {
    const std::uint32_t triangle = any_triangle();
    Case<Real> c;
    const auto take_corners = [&](std::uint32_t of) {
      const Triangle& t = mesh.triangles[of];
      c.a = mesh.vertices[t[0]];
      c.b = mesh.vertices[t[1]];
      c.c = mesh.vertices[t[2]];
    };
    if (rng.one_in(3)) {
      take_corners(triangle);
      detail::draw_ray(rng, style, c);
    } else {  // from one feature of the mesh to another, possibly begun well before or after it
      take_corners(any_triangle());
      const auto from = detail::draw_target(rng, c);
      take_corners(triangle);
      const auto to = detail::draw_target(rng, c);
      const oracle::Dyadic back(mpz_class(rng.coin() ? 0 : rng.between(-8, 1)), -rng.between(0, 3));
      c.ray.origin = rounded_point<Real>(from + back * (to - from));
      if (!is_finite(c.ray.origin)) continue;
      c.ray.direction = rounded_point<Real>(to - oracle::exact(c.ray.origin));
      if (rng.one_in(3)) {
        Real& x = component(rng.coin() ? c.ray.origin : c.ray.direction, rng.below(3));
        x = nudged(x, rng.between(-2, 2));
      }
    }
    if (!is_valid(c.ray)) continue;
    detail::draw_range(rng, c);
    return {c.ray, c.range, triangle};
  }
}

}  // namespace pierce::hard
