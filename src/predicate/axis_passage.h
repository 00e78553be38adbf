// SPDX-License-Identifier: Apache-2.0
//
// Passages of a ray along a coordinate axis: what crossings says (passage.h), for less. Seen along
// the axis a triangle is its shadow on the plane of the other two, so that three signs of 2 x 2
// determinants of differences tell whether the ray meets it; on which side of its plane the origin
// lies has to be asked only where their extents along the axis overlap.
#pragma once

#include <cstdint>

#include "predicate/ladder_counts.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// A direction along x (0), y (1) or z (2).
struct AxisDirection {
  std::uint8_t axis = 0;
  bool forward = true;
};

/// What a ray along an axis and a triangle have to do with each other.
enum class AxisPassage : signed char {
  Entering = -1,
  None = 0,
  Leaving = 1,
  OnTriangle = 2,  ///< the origin lies on the closed triangle; passages are then of no interest
};

/// OnTriangle if decide_on_triangle says so, else what decide_passage says of the unbounded ray.
AxisPassage decide_axis_passage(const Vec3<double>& origin, AxisDirection along,
                                const TriangleD& triangle, LadderCounts& counts);

/// What the line through a point along an axis has to do with the shadow of a triangle.
struct Shadow {
  int facing = 0;  ///< the sign of N's component along the axis; 0: a shadow without area
  /// The closed shadow holds the line; of a shadow without area: it may (decide_on_triangle tells).
  bool touched = false;
  bool passed = false;  ///< the shifted line (passage.h) goes through the triangle
};

Shadow decide_shadow(const Vec3<double>& point, std::uint8_t axis, const TriangleD& triangle,
                     LadderCounts& counts);

/// On which side of the line through p and q, both seen along the axis, the point lies when it is
/// shifted (passage.h): the sign of component `axis` of (p - point) x (q - point), 0 only if both
/// are seen in one place.
int decide_shifted_side(const Vec3<double>& point, std::uint8_t axis, const Vec3<double>& p,
                        const Vec3<double>& q, LadderCounts& counts);

/// The sign of N . (a - point): on which side of the triangle's plane the point lies, 0 in it.
int decide_side_of_plane(const Vec3<double>& point, const TriangleD& triangle,
                         LadderCounts& counts);

}  // namespace pierce::predicate
