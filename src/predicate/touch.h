// SPDX-License-Identifier: Apache-2.0
//
// Whether closed things have a point in common, exactly: a segment or a box and a triangle, or two
// triangles. A triangle without area is the segment, or the point, that it has shrunk to.
#pragma once

#include "predicate/ladder_counts.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// The segment may be a point.
bool decide_segment_touches(const Vec3<double>& from, const Vec3<double>& to,
                            const TriangleD& triangle, LadderCounts& counts);

/// No component of `lower` is above that of `upper`.
bool decide_box_touches(const Vec3<double>& lower, const Vec3<double>& upper,
                        const TriangleD& triangle, LadderCounts& counts);

/// Whether two triangles with area share more than common corners and edges: a point beside the
/// corners, or the whole edge, that both have. True if they are the same triangle.
bool decide_overlap(const TriangleD& p, const TriangleD& q, LadderCounts& counts);

}  // namespace pierce::predicate
