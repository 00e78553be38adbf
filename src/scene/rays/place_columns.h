// SPDX-License-Identifier: Apache-2.0
//
// Columns that need the ray or the triangle beside the hit: hit points and normals.
#pragma once

#include <cstddef>
#include <limits>

#include "pierce/arrays.h"
#include "predicate/place.h"
#include "scene/geometries.h"
#include "scene/strided.h"

namespace pierce::scene {

/// Stands for the point or the normal of a miss.
template <class Real>
inline constexpr Vec3<Real> kNowhere = {std::numeric_limits<Real>::quiet_NaN(),
                                        std::numeric_limits<Real>::quiet_NaN(),
                                        std::numeric_limits<Real>::quiet_NaN()};

template <class Real>
class PlaceColumns {
 public:
  /// Throws Error (SizeMismatch, InvalidArgument) unless each column that is wanted has a row for
  /// every ray.
  PlaceColumns(const HitArrays<Real>& arrays, std::size_t rays)
      : point_(arrays.point, rays, "ray", "point"),
        normal_(arrays.normal, rays, "ray", "normal"),
        unit_normal_(arrays.unit_normal, rays, "ray", "unit_normal") {}

  [[nodiscard]] bool wanted() const {
    return point_.wanted() || normal_.wanted() || unit_normal_.wanted();
  }
  void write(std::size_t row, const Ray<Real>& ray, const Hit<Real>& hit,
             const Geometries<Real>& geometries) const {
    if (hit.triangle == kNone) {
      if (point_.wanted()) point_.set(row, kNowhere<Real>);
      if (normal_.wanted()) normal_.set(row, kNowhere<Real>);
      if (unit_normal_.wanted()) unit_normal_.set(row, kNowhere<Real>);
      return;
    }
    const predicate::TriangleD triangle = geometries.triangle(geometries.primitive(hit));
    if (point_.wanted()) {
      const predicate::RayD line = predicate::to_double(ray, Range::Closed);
      point_.set(row, predicate::round_point<Real>(line, triangle));
    }
    if (normal_.wanted()) normal_.set(row, predicate::round_normal<Real>(triangle));
    if (unit_normal_.wanted()) unit_normal_.set(row, predicate::round_unit_normal<Real>(triangle));
  }

 private:
  OutputRows<Real> point_, normal_, unit_normal_;
};

}  // namespace pierce::scene
