// SPDX-License-Identifier: Apache-2.0
//
// From a ray to a FilterRay: by the quick road, all in float, where nothing needs rounding; else
// from the ray that double (or exact) arithmetic has placed.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kernels/bounds.h"
#include "kernels/kernel.h"

namespace pierce::kernels {

inline bool is_float(const Vec3<double>& p) {
  const auto same = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
  return same(p.x) && same(p.y) && same(p.z);
}

/// Sets the range from its ends in double, each within 2^-50 of the true one.
inline void set_range(double tau_min, double tau_max, FilterRay& ray) {
  ray.tau_min = static_cast<float>(tau_min - kTauPad);
  ray.tau_max = static_cast<float>(tau_max + kTauPad);
  ray.tau_first = static_cast<float>(tau_min + kTauPad);
  ray.tau_last = static_cast<float>(tau_max - kTauPad);
}

inline FilterRay filter_ray(const bvh::PlacedRay& placed, bool copies_exact) {
  FilterRay ray;
  ray.origin[0] = static_cast<float>(placed.origin.x);
  ray.origin[1] = static_cast<float>(placed.origin.y);
  ray.origin[2] = static_cast<float>(placed.origin.z);
  ray.direction[0] = static_cast<float>(placed.direction.x);
  ray.direction[1] = static_cast<float>(placed.direction.y);
  ray.direction[2] = static_cast<float>(placed.direction.z);
  set_range(placed.tau_min, placed.tau_max, ray);
  ray.exact =
      copies_exact && placed.origin_kept && is_float(placed.origin) && is_float(placed.direction);
  return ray;
}

/// The quick road, for float scenes that are only scaled and not moved: powers of two all the way,
/// so nothing is rounded (save into the subnormals: 2^-150, far below every bound's floor). False
/// if the ray is not for it: its origin is far away, or its direction's size is extreme.
inline bool quick_filter_ray(const bvh::FilterSpace& space, const Ray<float>& r, FilterRay& ray) {
  const float scale = space.float_scale();
  ray.origin[0] = r.origin.x * scale;
  ray.origin[1] = r.origin.y * scale;
  ray.origin[2] = r.origin.z * scale;
  const float reach =
      std::max({std::fabs(ray.origin[0]), std::fabs(ray.origin[1]), std::fabs(ray.origin[2])});
  const float size =
      std::max({std::fabs(r.direction.x), std::fabs(r.direction.y), std::fabs(r.direction.z)});
  const std::uint32_t biased =
      std::bit_cast<std::uint32_t>(size) >> 23;  // 2^(biased - 127) <= size
  if (!(reach <= bvh::kNearOrigin) || biased - 8 > 238) [[unlikely]]
    return false;
  const float shrink = std::bit_cast<float>((254 - biased) << 23);
  ray.direction[0] = r.direction.x * shrink;
  ray.direction[1] = r.direction.y * shrink;
  ray.direction[2] = r.direction.z * shrink;
  const double tau_scale = static_cast<double>(scale) / static_cast<double>(shrink);
  const auto limit = static_cast<double>(bvh::kTauLimit);
  set_range(std::clamp(static_cast<double>(r.t_min) * tau_scale, -limit, limit),
            std::clamp(static_cast<double>(r.t_max) * tau_scale, -limit, limit), ray);
  ray.exact = true;
  return true;
}

}  // namespace pierce::kernels
