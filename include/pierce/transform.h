// SPDX-License-Identifier: Apache-2.0
//
// Affine maps, and meshes placed by them: the same mesh in several places, turned, scaled, sheared
// or mirrored.
#pragma once

#include <array>

#include "pierce/error.h"
#include "pierce/types.h"

namespace pierce {

/// An affine map: row i times (x, y, z, 1) is coordinate i. The default is the identity.
template <class Real>
struct Transform {
  std::array<std::array<Real, 4>, 3> rows = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  friend bool operator==(const Transform&, const Transform&) = default;
};

/// Where the map takes the point: each coordinate is the exact value of m0 x + m1 y + m2 z + m3
/// rounded once to the nearest Real (ties to even; zero is +0). Throws Error (InvalidArgument) if a
/// number is not finite, (NonFiniteVertex) if one of the results is too large for Real. Some
/// tens of nanoseconds.
template <class Real>
[[nodiscard, gnu::visibility("default")]] Vec3<Real> transformed(const Transform<Real>& transform,
                                                                 const Vec3<Real>& point);

/// A mesh in its place. The triangles that a Scene sees have the corners
/// `transformed(transform, vertex)`: every answer is exact for these. Equal vertices stay equal, so
/// what is closed stays closed. A map that mirrors turns all triangles over: what was Front is
/// Back. A map whose determinant is zero is welcome; what it flattens is flat.
template <class Real>
struct Instance {
  MeshView<Real> mesh;
  Transform<Real> transform = {};
};

extern template Vec3<float> transformed(const Transform<float>&, const Vec3<float>&);
extern template Vec3<double> transformed(const Transform<double>&, const Vec3<double>&);

}  // namespace pierce
