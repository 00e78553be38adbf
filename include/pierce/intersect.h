// SPDX-License-Identifier: Apache-2.0
//
// One ray, one triangle, exactly: no scene needed.
#pragma once

#include <optional>

#include "pierce/error.h"
#include "pierce/types.h"

namespace pierce {

/// The hit of a ray with the triangle (a, b, c), or none. The same exact decision and the same
/// correctly rounded numbers that a Scene gives; geometry and triangle of the hit are 0.
///
/// The closed triangle counts, edges and vertices included; a ray in the triangle's plane and a
/// triangle without area never hit. Throws Error for a ray that is not valid (InvalidRay) or a
/// corner that is not finite (NonFiniteVertex). About 40 ns for float and 80 ns for
/// double; some 200 ns where only exact arithmetic can tell.
template <class Real>
[[nodiscard]] std::optional<Hit<Real>> intersect(const Ray<Real>& ray, const Vec3<Real>& a,
                                                 const Vec3<Real>& b, const Vec3<Real>& c,
                                                 Range range = Range::Closed);

extern template std::optional<Hit<float>> intersect(const Ray<float>&, const Vec3<float>&,
                                                    const Vec3<float>&, const Vec3<float>&, Range);
extern template std::optional<Hit<double>> intersect(const Ray<double>&, const Vec3<double>&,
                                                     const Vec3<double>&, const Vec3<double>&,
                                                     Range);

}  // namespace pierce
