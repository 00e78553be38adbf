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
std::strong_ordering settle_distance(const Vec3<double>& point, const NearTriangle& near,
                                     double radius);

/// All numbers by exact arithmetic, each rounded once.
template <class Real>
NearestPoint<Real> settle_nearest(const Vec3<double>& point, const NearTriangle& near);

extern template NearestPoint<float> settle_nearest<float>(const Vec3<double>&, const NearTriangle&);
extern template NearestPoint<double> settle_nearest<double>(const Vec3<double>&,
                                                            const NearTriangle&);

}  // namespace pierce::predicate
