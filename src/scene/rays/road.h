// SPDX-License-Identifier: Apache-2.0
//
// A ray's road into filter space: a wide one where it serves, else by the placed ray.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include "kernels/filter_ray.h"
#include "scene/geometries.h"

namespace pierce::scene {

/// Brings rays to filter space by the quick road or the plain one, whichever serves the scene.
/// Returns how many: all, or those before the first that has to be placed.
template <class Real>
std::size_t wide_roads(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
                       std::span<const Ray<Real>> rays, kernels::FilterRay* out) {
  if constexpr (std::is_same_v<Real, float>) {
    if (geometries.only_scaled()) {
      return kernel.quick_roads(geometries.space().float_scale(), rays.data(), rays.size(), out);
    }
  }
  const bvh::RoadSpace& space = geometries.road_space();
  return space.usable ? kernel.plain_roads(space, rays.data(), rays.size(), out) : 0;
}

/// The same for one ray: whether it is there.
template <class Real>
bool wide_road(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
               const Ray<Real>& ray, kernels::FilterRay& out) {
  return wide_roads(kernel, geometries, {&ray, 1}, &out) == 1;
}

template <class Real>
class Road {
 public:
  Road(const kernels::Kernel& kernel, const Geometries<Real>& geometries, const Ray<Real>& ray,
       Range range)
      : space_(geometries.space()), ray_(predicate::to_double(ray, range)) {
    if (wide_road(kernel, geometries, ray, filter_ray_)) return;
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
