// SPDX-License-Identifier: Apache-2.0
//
// Points that are hard to tell the nearest triangle of: on features, a hair beside them, equally
// far from two, far away, tiny, huge.
#pragma once

#include <cmath>
#include <cstdint>

#include "support/hard_numbers.h"
#include "support/meshes.h"

namespace pierce::hard {

/// k * p + q for a small k, in double, rounded; never NaN, and kept finite.
template <class Real>
Vec3<Real> mixed(double k, const Vec3<Real>& p, const Vec3<Real>& q) {
  const auto number = [&](Real x, Real y) {
    const double sum = k * static_cast<double>(x) + (1 - k) * static_cast<double>(y);
    return std::isfinite(sum) ? nudged(static_cast<Real>(sum), 0) : x;
  };
  return {number(p.x, q.x), number(p.y, q.y), number(p.z, q.z)};
}

template <class Real>
Vec3<Real> hard_point(Rng& rng, const Mesh<Real>& mesh, Style style) {
  const auto vertex = [&] { return mesh.vertices[rng.below(mesh.vertices.size())]; };
  const auto& triangle = mesh.triangles[rng.below(mesh.triangles.size())];
  const auto corner = [&](std::size_t i) { return mesh.vertices[triangle[i]]; };
  const auto nudge_all = [&](Vec3<Real> p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      component(p, axis) = nudged(component(p, axis), rng.between(-2, 2));
    }
    return p;
  };
  const auto scaled = [](Vec3<Real> p, int exponent) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      component(p, axis) = nudged(std::ldexp(component(p, axis), exponent), 0);
    }
    return p;
  };
  Vec3<Real> p;
  switch (rng.below(10)) {
    case 0:
      p = vec<Real>(rng, style);
      break;
    case 1:
      p = vertex();
      break;
    case 2:  // on an edge, as well as rounding allows
      p = mixed(rng.one_in(2) ? 0.5 : rng.unit(), corner(0), corner(1));
      break;
    case 3: {  // on a face
      p = mixed(rng.one_in(2) ? 0.25 : rng.unit(), corner(2),
                mixed(rng.one_in(2) ? 0.5 : rng.unit(), corner(0), corner(1)));
      break;
    }
    case 4:  // half way between two vertices
      p = mixed(0.5, vertex(), vertex());
      break;
    case 5: {  // shifted along an axis
      p = mixed(0.5, corner(0), corner(1));
      component(p, rng.below(3)) = number<Real>(rng, style);
      break;
    }
    case 6:  // far away
      p = scaled(vec<Real>(rng, style), rng.between(1, 60));
      break;
    case 7:  // very far, or very near the origin
      p = scaled(vec<Real>(rng, style), rng.between(-2000, 2000));
      break;
    case 8:
      p = vec<Real>(rng, Style::Mixed);
      break;
    default: {  // the mirror image of a corner in another: the edge seen end-on
      p = mixed(2, corner(0), corner(1));
      break;
    }
  }
  return rng.one_in(3) ? nudge_all(p) : p;
}

}  // namespace pierce::hard
