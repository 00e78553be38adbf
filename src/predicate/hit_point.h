// SPDX-License-Identifier: Apache-2.0
//
// The point X in which a ray meets a triangle, as exactly as it is wanted, and what lies between it
// and a point s near by. For the origin of the next ray: s must be reached from the ray itself,
// just before X or just beyond it, without meeting any triangle.
#pragma once

#include "exact/bounded.h"
#include "exact/double_double.h"
#include "pierce/types.h"
#include "predicate/determinants.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// A hit, and the way to go on from it: `towards` is the ray's direction (Side::Beyond) or its
/// opposite (Side::Before).
struct HitPoint {
  using Number = exact::Bounded<exact::DoubleDouble>;

  RayD ray;  // only origin and direction
  TriangleD triangle;
  Vec3<double> towards;
  Triple<Number> near;  // X; the errors may be large, or infinite
  int way_side;         // of the triangle's plane, to which the way leads: the sign of N . towards

  /// The ray must hit the triangle, its range apart.
  HitPoint(const RayD& ray, const TriangleD& triangle, Side side);

  /// X, each number rounded to nearest (or, far from zero on the scale of X, within 2^-90).
  [[nodiscard]] Vec3<double> rounded() const;
};

/// On which side of a triangle's plane s lies: +1 where its normal points, -1, or 0.
int decide_side(const Vec3<double>& s, const TriangleD& triangle);

/// Whether the other triangle leaves the way open from s to the points of the ray next to X on the
/// wanted side: the segment from s to each of these that is near enough to X does not meet it. A
/// triangle without area is in the way only if s lies on it.
bool decide_open(const HitPoint& hit, const Vec3<double>& s, const TriangleD& other);

/// On which side of the other triangle's plane the way runs, next to X: the side that X itself lies
/// on, or if it lies in the plane, that to which the way leads; 0 if that stays in the plane.
int decide_way(const HitPoint& hit, const TriangleD& other);

}  // namespace pierce::predicate
