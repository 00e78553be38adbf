// SPDX-License-Identifier: Apache-2.0
//
// The exact rung of the nearest point: never unsure, for every finite input. Integers as in
// settle.h: one digit, two, four, or integers of any size for each coordinate.
#pragma once

#include <compare>

#include "pierce/nearest.h"
#include "predicate/nearest.h"
#include "predicate/settle.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// The feature that is nearest to the point.
struct SettledFeature {
  Feature feature;
  Width width;
};
SettledFeature settle_feature(const Vec3<double>& point, const TriangleD& triangle);

/// Compares the distances of two triangles, whose features are known.
std::strong_ordering settle_nearer(const Vec3<double>& point, const NearTriangle& first,
                                   const NearTriangle& second);

/// Compares the distance with a finite radius.
std::strong_ordering compare_distance(const Vec3<double>& point, const NearTriangle& near,
                                      double radius);

/// The distance, by exact arithmetic and rounded once.
template <class Real>
Real settle_distance(const Vec3<double>& point, const NearTriangle& near);

/// The nearest point and its weights likewise; the feature that holds it is no corner. The rest of
/// `result` is left alone.
template <class Real>
void settle_nearest(const Vec3<double>& point, const NearTriangle& near,
                    NearestPoint<Real>& result);

extern template float settle_distance<float>(const Vec3<double>&, const NearTriangle&);
extern template double settle_distance<double>(const Vec3<double>&, const NearTriangle&);
extern template void settle_nearest(const Vec3<double>&, const NearTriangle&, NearestPoint<float>&);
extern template void settle_nearest(const Vec3<double>&, const NearTriangle&,
                                    NearestPoint<double>&);

}  // namespace pierce::predicate
