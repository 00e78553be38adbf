// SPDX-License-Identifier: Apache-2.0
//
// A plane that cuts a picture open.
#pragma once

#include <algorithm>
#include <optional>

#include "pierce/types.h"
#include "pierce/vector.h"

namespace pierce::tool {

/// What lies beyond the plane, where normal . p > offset, is not seen.
struct Section {
  Vec3<double> normal;
  double offset;

  /// Shortens the ray to what is seen. True: it comes in through the plane.
  template <class Real>
  bool clip(Ray<Real>& ray) const {
    const double room = offset - dot(normal, convert<double>(ray.origin));
    const double along = dot(normal, convert<double>(ray.direction));
    if (room < 0 && along >= 0) {
      ray.t_max = -kInfinity<Real>;
      return false;
    }
    const auto t = static_cast<Real>(room / along);
    if (along > 0) ray.t_max = std::min(ray.t_max, t);
    if (along < 0 && room < 0) ray.t_min = std::max(ray.t_min, t);
    return along < 0 && room < 0;
  }
};

}  // namespace pierce::tool
