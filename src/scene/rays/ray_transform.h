// SPDX-License-Identifier: Apache-2.0
//
// Transforms rays to filter space: in lanes for ordinary ones, else in general double arithmetic or
// exactly.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "scene/geometries.h"
#include "scene/validate_input.h"
#include "space/filter_ray.h"

namespace pierce::scene {

/// Transforms a prefix of the rays in lanes, by scaling or by the affine map, whichever serves the
/// scene; returns its length. The next ray needs transform_one.
template <class Real>
std::size_t transform_in_lanes(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
                               std::span<const Ray<Real>> rays, space::FilterRay* out) {
  if constexpr (std::is_same_v<Real, float>) {
    if (geometries.only_scaled()) {
      return kernel.transform_scaled(geometries.space().float_scale(), rays.data(), rays.size(),
                                     out);
    }
  }
  const space::AffineMap& map = geometries.affine_map();
  return map.usable ? kernel.of<Real>().transform_affine(map, rays.data(), rays.size(), out) : 0;
}

/// How a ray got there.
struct Transformed {
  bool in_lanes = false;
  bool exactly = false;  // by exact arithmetic
  bool misses = false;   // its line misses the scene's box, and it is not there
};

/// Transforms a ray that lanes do not take, so the only one that may be bad: throws Error
/// (InvalidRay) if it is. Apart, so that what follows a ray which they do take waits for nothing.
template <class Real>
[[gnu::cold, gnu::noinline]] Transformed transform_one(const Geometries<Real>& geometries,
                                                       const Ray<Real>& ray, Range range,
                                                       space::FilterRay& out) {
  validate_ray(ray);
  const space::TransformedRay general =
      geometries.space().transform(predicate::to_double(ray, range));
  if (!general.misses) out = space::filter_ray(general, geometries.copies_exact());
  return {.exactly = general.exactly, .misses = general.misses};
}

/// Transforms any ray. Throws Error (InvalidRay) if it is not valid.
template <class Real>
[[gnu::always_inline]] inline Transformed transform(const kernels::Kernel& kernel,
                                                    const Geometries<Real>& geometries,
                                                    const Ray<Real>& ray, Range range,
                                                    space::FilterRay& out) {
  if (transform_in_lanes<Real>(kernel, geometries, {&ray, 1}, &out) == 1) [[likely]]
    return {.in_lanes = true};
  return transform_one(geometries, ray, range, out);
}

}  // namespace pierce::scene
