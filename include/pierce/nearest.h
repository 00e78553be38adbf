// SPDX-License-Identifier: Apache-2.0
//
// The nearest point of a scene's surface: what is answered, and what may be asked for.
#pragma once

#include <cstdint>
#include <span>

#include "pierce/options.h"
#include "pierce/types.h"

namespace pierce {

/// The part of a triangle (a, b, c) that holds a point: a corner, else the inside of an edge, else
/// the inside of the face. On a triangle without area several may; the first in this order counts.
enum class Feature : std::uint8_t { VertexA, VertexB, VertexC, EdgeAB, EdgeBC, EdgeCA, Face };

/// The point of the surface that is nearest to a given one.
///
/// It is `w a + u b + v c` of its triangle. Each number is the exact value rounded once to Real
/// (ties to even, zero is +0): so u + v + w need not be exactly 1, and `point` need not lie exactly
/// on the triangle. A default-made one means that there is none.
template <class Real>
struct NearestPoint {
  Vec3<Real> point{0, 0, 0};
  Real distance = kInfinity<Real>;
  Real u = 0, v = 0, w = 0;
  std::uint32_t geometry = kNone;  ///< index of the mesh in the scene
  std::uint32_t triangle = kNone;  ///< index of the triangle in that mesh; kNone: there is none
  Feature feature = Feature::Face;

  friend bool operator==(const NearestPoint&, const NearestPoint&) = default;
};

/// The distance with the sign that belongs to the point's location: negative inside. 0 stays +0.
template <class Real>
[[nodiscard]] Real with_sign(Real distance, Location location) {
  return location == Location::Inside && distance != 0 ? -distance : distance;
}

/// For a batch of points.
template <class Real>
struct NearestOptions {
  /// Surface farther away than this does not count; exactly as far away does. Not negative, not
  /// NaN.
  Real radius = kInfinity<Real>;
  /// Either empty or one radius a point, in place of `radius`.
  std::span<const Real> radii = {};
  WorkOptions work = {};  ///< a point counts as a ray in its statistics
};

}  // namespace pierce
