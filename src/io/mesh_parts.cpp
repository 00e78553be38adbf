// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_parts.h"

#include <algorithm>

namespace pierce::io {

void scale_colors(std::vector<Vec3<float>>& colors) {
  const bool bytes = std::any_of(colors.begin(), colors.end(), [](const Vec3<float>& c) {
    return c.x > 1 || c.y > 1 || c.z > 1;
  });
  if (!bytes) return;
  for (Vec3<float>& c : colors) c = {c.x / 255, c.y / 255, c.z / 255};
}

bool all_floats(std::span<const Vec3<double>> vertices) {
  const auto is_float = [](double x) { return static_cast<double>(nearest_float(x)) == x; };
  return std::all_of(vertices.begin(), vertices.end(), [&](const Vec3<double>& p) {
    return is_float(p.x) && is_float(p.y) && is_float(p.z);
  });
}

}  // namespace pierce::io
