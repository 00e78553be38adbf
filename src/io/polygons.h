// SPDX-License-Identifier: Apache-2.0
//
// Polygons into triangles, without new vertices. Each is fanned from its first corner; where that
// would reach over its border, as in many concave ones, it is triangulated within it. Exact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/mesh.h"

namespace pierce::io {

/// Notes the polygons of a mesh as they are read, and sees to them when all vertices are there.
class Polygons {
 public:
  /// Appends the polygon's fan: (0 1 2), (0 2 3) ... Fewer than three corners make no triangle.
  void append(std::span<const std::uint32_t> corners, std::vector<Triangle>& triangles);

  /// Triangulates again what a fan is wrong for, and counts (see Mesh::polygons). What is concave
  /// is decided in the polygon's shadow along the axis that its normal is nearest to. Warns of
  /// those whose border crosses itself: they stay fans.
  void finish(Mesh& mesh) const;

 private:
  struct Fan {
    std::uint64_t first;      // of its triangles
    std::uint32_t triangles;  // at least two
  };
  std::vector<Fan> fans_;
};

}  // namespace pierce::io
