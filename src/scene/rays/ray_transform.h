// SPDX-License-Identifier: Apache-2.0
//
// Transforms a ray to filter space: in lanes for ordinary rays, else in general double or exactly.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include "kernels/filter_ray.h"
#include "scene/geometries.h"

namespace pierce::scene {

/// Brings rays to filter space by the quick road or the plain one, whichever serves the scene.
/// Returns how many: all, or those before the first that has to be transformed.
template <class Real>
std::size_t transform_rays(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
                           std::span<const Ray<Real>> rays, kernels::FilterRay* out) {
  if constexpr (std::is_same_v<Real, float>) {
    if (geometries.only_scaled()) {
      return kernel.transform_scaled(geometries.space().float_scale(), rays.data(), rays.size(),
                                     out);
    }
  }
  const bvh::AffineMap& space = geometries.affine_map();
  return space.usable ? kernel.transform_affine(space, rays.data(), rays.size(), out) : 0;
}

/// The same for one ray: whether it is there.
template <class Real>
bool transform_ray(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
                   const Ray<Real>& ray, kernels::FilterRay& out) {
  return transform_rays(kernel, geometries, {&ray, 1}, &out) == 1;
}

template <class Real>
class Road {
 public:
  Road(const kernels::Kernel& kernel, const Geometries<Real>& geometries, const Ray<Real>& ray,
       Range range)
      : space_(geometries.space()), ray_(predicate::to_double(ray, range)) {
    if (transform_ray(kernel, geometries, ray, filter_ray_)) return;
    transformed_ = space_.transform(ray_);
    filter_ray_ = kernels::filter_ray(*transformed_, geometries.copies_exact());
  }

  [[nodiscard]] const predicate::RayD& ray() const { return ray_; }
  [[nodiscard]] const kernels::FilterRay& filter_ray() const { return filter_ray_; }
  /// The line passes the scene's box by.
  [[nodiscard]] bool misses() const { return transformed_.has_value() && transformed_->misses; }
  [[nodiscard]] bool exactly() const { return transformed_.has_value() && transformed_->exactly; }
  [[nodiscard]] const bvh::TransformedRay& transformed() {
    if (!transformed_) transformed_ = space_.transform(ray_);
    return *transformed_;
  }

 private:
  const bvh::FilterSpace& space_;
  predicate::RayD ray_;
  kernels::FilterRay filter_ray_;
  std::optional<bvh::TransformedRay> transformed_;
};

}  // namespace pierce::scene
