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
[[nodiscard, gnu::visibility("default")]] std::optional<Hit<Real>> intersect(
    const Ray<Real>& ray, const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c,
    Range range = Range::Closed);

/// The exact point o + t d in which the ray's line pierces the triangle (in its range or not), each
/// coordinate rounded once (zero is +0). So it need not lie exactly on the ray, nor on the
/// triangle. Throws what intersect throws, and Error (InvalidArgument) if the line does not hit the
/// triangle.
template <class Real>
[[nodiscard, gnu::visibility("default")]] Vec3<Real> hit_point(const Ray<Real>& ray,
                                                               const Vec3<Real>& a,
                                                               const Vec3<Real>& b,
                                                               const Vec3<Real>& c);

/// N = (b - a) x (c - a), whose length is twice the triangle's area: each component rounded once,
/// infinite where it is too large for Real, +0 where it is zero. Throws Error (NonFiniteVertex).
template <class Real>
[[nodiscard, gnu::visibility("default")]] Vec3<Real> normal(const Vec3<Real>& a,
                                                            const Vec3<Real>& b,
                                                            const Vec3<Real>& c);

/// N / |N|, each component rounded once; (0, 0, 0) for a triangle without area.
template <class Real>
[[nodiscard, gnu::visibility("default")]] Vec3<Real> unit_normal(const Vec3<Real>& a,
                                                                 const Vec3<Real>& b,
                                                                 const Vec3<Real>& c);

extern template std::optional<Hit<float>> intersect(const Ray<float>&, const Vec3<float>&,
                                                    const Vec3<float>&, const Vec3<float>&, Range);
extern template std::optional<Hit<double>> intersect(const Ray<double>&, const Vec3<double>&,
                                                     const Vec3<double>&, const Vec3<double>&,
                                                     Range);
extern template Vec3<float> hit_point(const Ray<float>&, const Vec3<float>&, const Vec3<float>&,
                                      const Vec3<float>&);
extern template Vec3<double> hit_point(const Ray<double>&, const Vec3<double>&, const Vec3<double>&,
                                       const Vec3<double>&);
extern template Vec3<float> normal(const Vec3<float>&, const Vec3<float>&, const Vec3<float>&);
extern template Vec3<double> normal(const Vec3<double>&, const Vec3<double>&, const Vec3<double>&);
extern template Vec3<float> unit_normal(const Vec3<float>&, const Vec3<float>&, const Vec3<float>&);
extern template Vec3<double> unit_normal(const Vec3<double>&, const Vec3<double>&,
                                         const Vec3<double>&);

}  // namespace pierce
