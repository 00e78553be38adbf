// SPDX-License-Identifier: Apache-2.0
//
// From a ray to a FilterRay: by the quick road, all in float, where nothing needs rounding; else
// from the ray that double (or exact) arithmetic has placed.
#pragma once

#include <limits>

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

/// No hit is certain any more: of every triangle that is not discarded the referee is asked.
inline void doubt_all_hits(FilterRay& ray) {
  ray.tau_first = std::numeric_limits<float>::infinity();
}

inline FilterRay filter_ray(const bvh::PlacedRay& placed, bool copies_exact) {
  FilterRay ray;
  ray.origin[0] = static_cast<float>(placed.origin.x);
  ray.origin[1] = static_cast<float>(placed.origin.y);
  ray.origin[2] = static_cast<float>(placed.origin.z);
  ray.origin[3] = 0;
  ray.direction[0] = static_cast<float>(placed.direction.x);
  ray.direction[1] = static_cast<float>(placed.direction.y);
  ray.direction[2] = static_cast<float>(placed.direction.z);
  ray.direction[3] = 1;
  set_range(placed.tau_min, placed.tau_max, ray);
  ray.exact =
      copies_exact && placed.origin_kept && is_float(placed.origin) && is_float(placed.direction);
  ray.tau_scale = placed.tau_scale;
  return ray;
}

}  // namespace pierce::kernels
