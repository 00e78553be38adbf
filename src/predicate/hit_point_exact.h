// SPDX-License-Identifier: Apache-2.0
//
// The exact rung of hit_point.h: integers of any size, never unsure.
#pragma once

#include "predicate/hit_point.h"

namespace pierce::predicate {

Vec3<double> rounded_exactly(const HitPoint& hit);
int side_exactly(const Vec3<double>& s, const TriangleD& triangle);
/// The sign of N . direction.
int direction_exactly(const TriangleD& triangle, const Vec3<double>& direction);
int way_exactly(const HitPoint& hit, const TriangleD& other);
bool open_exactly(const HitPoint& hit, const Vec3<double>& s, const TriangleD& other);

}  // namespace pierce::predicate
