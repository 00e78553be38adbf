// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "kernels/kernel.h"

namespace pierce::kernels {
namespace {

float rounded_down(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) <= x ? f : std::nextafter(f, -bvh::kEmptyPlane);
}

float rounded_up(double x) { return -rounded_down(-x); }

}  // namespace

FilterRay filter_ray(const bvh::PlacedRay& placed) {
  return {{static_cast<float>(placed.origin.x), static_cast<float>(placed.origin.y),
           static_cast<float>(placed.origin.z)},
          {static_cast<float>(placed.direction.x), static_cast<float>(placed.direction.y),
           static_cast<float>(placed.direction.z)},
          rounded_down(placed.tau_min),
          rounded_up(placed.tau_max),
          rounded_up(placed.tau_first),
          rounded_down(placed.tau_last)};
}

}  // namespace pierce::kernels
