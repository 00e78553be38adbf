// SPDX-License-Identifier: Apache-2.0
//
// The ladder for one point and one triangle: where the triangle is nearest to the point, which of
// two triangles is nearer, and the numbers. Double first, exact where double is unsure; everything
// that scenes answer about distances goes through these functions.
#pragma once

#include <compare>
#include <optional>

#include "pierce/nearest.h"
#include "predicate/certify.h"
#include "predicate/ladder_counts.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// A triangle of which it is decided which of its features is nearest to the point.
struct NearTriangle {
  TriangleD triangle;
  Feature feature;
  Interval squared;  // holds the true squared distance
};

NearTriangle decide_near(const Vec3<double>& point, const TriangleD& triangle,
                         LadderCounts& counts);

/// Whether double alone is sure that the triangle is farther away than `known`.
bool surely_farther(const Vec3<double>& point, const NearTriangle& known,
                    const TriangleD& triangle);

/// Whether a corner of `known` holds its nearest point, is a corner of `triangle` too, and surely
/// holds the nearest point of that one as well: then they are equally near. Nothing if that is not
/// so, or not sure.
std::optional<NearTriangle> near_in_same_corner(const Vec3<double>& point,
                                                const NearTriangle& known,
                                                const TriangleD& triangle);

/// Compares the distances of two triangles.
std::strong_ordering decide_nearer(const Vec3<double>& point, const NearTriangle& first,
                                   const NearTriangle& second, LadderCounts& counts);

/// Whether the distance is at most `radius`, which is not negative; it may be infinite.
bool decide_within(const Vec3<double>& point, const NearTriangle& near, double radius,
                   LadderCounts& counts);

/// The nearest point of the triangle and its numbers, each correctly rounded to Real; the names are
/// left alone.
template <class Real>
NearestPoint<Real> round_nearest(const Vec3<double>& point, const NearTriangle& near,
                                 LadderCounts& counts);

extern template NearestPoint<float> round_nearest<float>(const Vec3<double>&, const NearTriangle&,
                                                         LadderCounts&);
extern template NearestPoint<double> round_nearest<double>(const Vec3<double>&, const NearTriangle&,
                                                           LadderCounts&);

}  // namespace pierce::predicate
