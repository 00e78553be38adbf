// SPDX-License-Identifier: Apache-2.0
//
// The box of meshes, of all vertices that triangles use: others are not seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "pierce/types.h"
#include "pierce/vector.h"

namespace pierce::tool {

/// Empty boxes have infinities the wrong way round.
struct Box {
  Vec3<double> low, high;

  [[nodiscard]] Vec3<double> centre() const { return 0.5 * low + 0.5 * high; }
  [[nodiscard]] double diagonal() const {
    const Vec3<double> d = high - low;
    return std::hypot(d.x, d.y, d.z);
  }
};

/// Calls `visit` with every corner of every triangle.
template <class Real, class Visit>
void for_each_corner(std::span<const MeshView<Real>> meshes, Visit visit) {
  for (const MeshView<Real>& mesh : meshes) {
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) visit(convert<double>(mesh.vertices[v]));
    }
  }
}

template <class Real>
[[nodiscard]] Box box_of(std::span<const MeshView<Real>> meshes) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box box = {{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}};
  for_each_corner(meshes, [&](const Vec3<double>& p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  });
  return box;
}

}  // namespace pierce::tool
