// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pierce/scene.h"

namespace pierce::hard {

/// Where the points lie, asked as a batch.
template <class Real>
std::vector<Location> located(const Scene<Real>& scene, const std::vector<Vec3<Real>>& points,
                              const LocateOptions& options = {}) {
  std::vector<Location> locations(points.size());
  scene.locate(points, locations, options);
  return locations;
}

}  // namespace pierce::hard
