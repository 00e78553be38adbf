// SPDX-License-Identifier: Apache-2.0
//
// How near a point is to boxes and triangles, in double, in the scene's filter space, to which
// boxes of the meshes' trees are brought one by one, for a placement need not keep distances. For a
// point so far away that all distances look alike, what counts instead is how far things reach
// towards it (kernels/points/nearest_plain.cpp): the farther, the less its "distance".
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/points/nearest.h"
#include "predicate/bounds.h"
#include "predicate/nearest.h"
#include "scene/two_level.h"
#include "space/filter_space.h"

namespace pierce::scene {

class PointDistance {
 public:
  PointDistance(const space::FilterSpace& space, const kernels::FilterPoint& point)
      : space_(space),
        point_(point.position),
        direction_(point.direction),
        size_(std::max({std::fabs(point_.x), std::fabs(point_.y), std::fabs(point_.z)})),
        far_(!(size_ <= bounds::kNearestFarthest)),
        limit_(far_ ? kInfinity<double> : point.limit) {}

  [[nodiscard]] bool is_far() const { return far_; }
  /// That of the point, as a distance.
  [[nodiscard]] double limit() const { return limit_; }

  /// A little less than the distance to anything in the box of a child, of which copies may be off
  /// by `more`; `placed` says in whose space that is (null: in the scene's).
  [[nodiscard]] double to(space::MiddleBox box, double more, const Placed* placed) const {
    box.half = {box.half.x + more, box.half.y + more, box.half.z + more};
    if (placed != nullptr) box = placed->space.to_scene(box);
    const Vec3<double>&m = box.middle, &h = box.half;
    if (far_) {
      const Vec3<double>& d = direction_;
      return -(d.x * m.x + d.y * m.y + d.z * m.z) -
             (std::fabs(d.x) * h.x + std::fabs(d.y) * h.y + std::fabs(d.z) * h.z) -
             bounds::kNearestFar;
    }
    const auto outside = [](double p, double middle, double half) {
      return std::max(std::fabs(p - middle) - half, 0.0);
    };
    const double x = outside(point_.x, m.x, h.x);
    const double y = outside(point_.y, m.y, h.y);
    const double z = outside(point_.z, m.z, h.z);
    return std::sqrt(x * x + y * y + z * z) - bounds::kNearestPlainReach * (1 + size_);
  }

  /// What is beyond this is farther away than the triangle.
  [[nodiscard]] double beyond(const predicate::NearTriangle& near) const {
    if (!far_) return space_.map_length(std::sqrt(near.squared.high) * (1 + 0x1p-50));
    double least = kInfinity<double>;
    for (const Vec3<double>& corner : {near.triangle.a, near.triangle.b, near.triangle.c}) {
      const Vec3<double> p = space_.map(corner);
      const double reach = -(direction_.x * p.x + direction_.y * p.y + direction_.z * p.z);
      least = std::min(least, reach + bounds::kNearestFar);
    }
    return least;
  }

 private:
  const space::FilterSpace& space_;
  Vec3<double> point_, direction_;
  double size_;
  bool far_;
  double limit_;
};

}  // namespace pierce::scene
