// SPDX-License-Identifier: Apache-2.0
//
// Where a ray meets a triangle, and which way the triangle faces: points and normals, each
// coordinate correctly rounded. Computed with more bits than asked for and with the error that each
// step adds (exact/bounded.h), taken if that is enough to round, else computed with twice as many,
// else exactly. docs/algorithm.md ("Points and normals") says why.
#pragma once

#include "predicate/types.h"

namespace pierce::predicate {

/// The point of the ray's line on the triangle's plane, which it surely pierces; the range means
/// nothing.
template <class Real>
Vec3<Real> round_point(const RayD& ray, const TriangleD& triangle);

/// N = (b - a) x (c - a). What is too large is infinite.
template <class Real>
Vec3<Real> round_normal(const TriangleD& triangle);

/// N / |N|; zero for a triangle without area.
template <class Real>
Vec3<Real> round_unit_normal(const TriangleD& triangle);

extern template Vec3<float> round_point<float>(const RayD&, const TriangleD&);
extern template Vec3<double> round_point<double>(const RayD&, const TriangleD&);
extern template Vec3<float> round_normal<float>(const TriangleD&);
extern template Vec3<double> round_normal<double>(const TriangleD&);
extern template Vec3<float> round_unit_normal<float>(const TriangleD&);
extern template Vec3<double> round_unit_normal<double>(const TriangleD&);

}  // namespace pierce::predicate
