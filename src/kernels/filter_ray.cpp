// SPDX-License-Identifier: Apache-2.0
#include "kernels/bounds.h"
#include "kernels/kernel.h"

namespace pierce::kernels {
namespace {

bool is_float(double x) { return static_cast<double>(static_cast<float>(x)) == x; }

bool is_float(const Vec3<double>& p) { return is_float(p.x) && is_float(p.y) && is_float(p.z); }

}  // namespace

FilterRay filter_ray(const bvh::PlacedRay& placed, bool copies_exact) {
  return {
      {static_cast<float>(placed.origin.x), static_cast<float>(placed.origin.y),
       static_cast<float>(placed.origin.z)},
      {static_cast<float>(placed.direction.x), static_cast<float>(placed.direction.y),
       static_cast<float>(placed.direction.z)},
      static_cast<float>(placed.tau_min - kTauPad),
      static_cast<float>(placed.tau_max + kTauPad),
      static_cast<float>(placed.tau_min + kTauPad),
      static_cast<float>(placed.tau_max - kTauPad),
      copies_exact && placed.origin_kept && is_float(placed.origin) && is_float(placed.direction)};
}

}  // namespace pierce::kernels
