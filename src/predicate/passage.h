// SPDX-License-Identifier: Apache-2.0
//
// Crossings: whether a ray passes through a triangle when its origin is shifted by the symbolic
// s = (e, e^2, e^3), e -> 0. Through an edge or a vertex of a closed surface exactly as many
// triangles are passed as the surface is crossed.
//
// The side of an edge (p, q), d . ((p - o) x (q - o)), becomes itself plus s . (d x (q - p)), and
// T = N . (a - o) becomes itself minus s . N. Where the first is zero, the sign of the second
// is that of its first component that is not zero: s_x outweighs s_y outweighs s_z.
#pragma once

#include "predicate/ladder_counts.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// How the shifted ray passes through a triangle.
enum class Passage : signed char { Entering = -1, None = 0, Leaving = 1 };

/// The passage within the range of t (its ends, too, are compared after the shift). A triangle in a
/// plane with the direction is never passed. Double first, exact where that is unsure.
Passage decide_passage(const RayD& ray, const TriangleD& triangle, LadderCounts& counts);

/// Whether the point lies on the closed triangle, exactly; a triangle without area is the segment,
/// or the point, that it has shrunk to.
bool decide_on_triangle(const Vec3<double>& point, const TriangleD& triangle);

}  // namespace pierce::predicate
