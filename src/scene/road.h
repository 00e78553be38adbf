// SPDX-License-Identifier: Apache-2.0
//
// A ray's road into filter space: the quick one where it serves, else by the placed ray.
#pragma once

#include <optional>
#include <type_traits>

#include "kernels/filter_ray.h"
#include "scene/geometries.h"

namespace pierce::scene {

/// Takes the quick road if it serves this scene and this ray.
template <class Real>
bool quick_road(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
                const Ray<Real>& ray, kernels::FilterRay& out) {
  if constexpr (std::is_same_v<Real, float>) {
    return geometries.copies_exact() &&
           kernel.quick_roads(geometries.space().float_scale(), &ray, 1, &out) == 1;
  } else {
    return false;
  }
}

template <class Real>
class Road {
 public:
  Road(const kernels::Kernel& kernel, const Geometries<Real>& geometries, const Ray<Real>& ray,
       Range range)
      : space_(geometries.space()), ray_(predicate::to_double(ray, range)) {
    if (quick_road(kernel, geometries, ray, filter_ray_)) return;
    placed_ = space_.place(ray_);
    filter_ray_ = kernels::filter_ray(*placed_, geometries.copies_exact());
  }

  [[nodiscard]] const predicate::RayD& ray() const { return ray_; }
  [[nodiscard]] const kernels::FilterRay& filter_ray() const { return filter_ray_; }
  /// The line passes the scene's box by.
  [[nodiscard]] bool misses() const { return placed_.has_value() && placed_->misses; }
  [[nodiscard]] bool exactly() const { return placed_.has_value() && placed_->exactly; }
  [[nodiscard]] const bvh::PlacedRay& placed() {
    if (!placed_) placed_ = space_.place(ray_);
    return *placed_;
  }

 private:
  const bvh::FilterSpace& space_;
  predicate::RayD ray_;
  kernels::FilterRay filter_ray_;
  std::optional<bvh::PlacedRay> placed_;
};

}  // namespace pierce::scene
