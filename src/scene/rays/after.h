// SPDX-License-Identifier: Apache-2.0
//
// The hit of a ray's whole line with one triangle: where to go on from.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "predicate/decide.h"
#include "scene/geometries.h"
#include "scene/rays/ray_source.h"
#include "scene/rays/sight.h"

namespace pierce::scene {

template <class Real>
predicate::RayD line_of(const Ray<Real>& ray) {
  predicate::RayD line = predicate::to_double(ray, Range::Closed);
  line.t_min = -std::numeric_limits<double>::infinity();
  line.t_max = std::numeric_limits<double>::infinity();
  return line;
}

/// False if the line does not hit the triangle, or there is no such triangle.
template <class Real>
bool find_hit(const Geometries<Real>& geometries, const predicate::RayD& line,
              const TriangleRef& ref, After& after, predicate::LadderCounts& counts) {
  after.primitive = geometries.primitive(ref);
  return after.primitive != kNone &&
         predicate::decide_hit(line, geometries.triangle(after.primitive), after.hit, counts);
}

/// The ray without what surely lies before a hit of its line whose t is rounded to `t`: from the
/// number below on, which is less than the exact t.
template <class Real>
Ray<Real> from_below(const Ray<Real>& ray, Real t) {
  Ray<Real> rest = ray;
  rest.t_min = std::max(ray.t_min, std::nextafter(t, -kInfinity<Real>));
  return rest;
}

template <class Real>
Ray<Real> from_below(const Ray<Real>& ray, const After& after, predicate::LadderCounts& counts) {
  const auto hit = predicate::round_hit<Real>(predicate::to_double(ray, Range::Closed),
                                              after.hit.triangle, after.hit.zeros, counts);
  return from_below(ray, hit.t);
}

/// Throws Error (InvalidArgument) unless the triangle is none, or one of the scene that the ray's
/// line hits.
template <class Real>
void validate_after(const Geometries<Real>& geometries, const Ray<Real>& ray,
                    const TriangleRef& after);

/// The same for a batch: names the first bad one and counts them. Rays that are not valid are
/// passed over.
template <class Real>
void validate_after(const Geometries<Real>& geometries, const RaySource<Real>& rays,
                    const BatchOptions& options);

}  // namespace pierce::scene
