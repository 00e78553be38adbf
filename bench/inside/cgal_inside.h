// SPDX-License-Identifier: Apache-2.0
//
// CGAL's Side_of_triangle_mesh over exact predicates: an exact point-in-solid test, point by point.
#pragma once

#include <memory>
#include <span>

#include "pierce/types.h"

namespace pierce::bench {

class CgalInside {
 public:
  /// Throws std::runtime_error if CGAL cannot make a surface of the mesh.
  explicit CgalInside(MeshView<float> mesh);
  ~CgalInside();
  CgalInside(const CgalInside&) = delete;
  CgalInside& operator=(const CgalInside&) = delete;

  void locate(std::span<const Vec3<float>> points, std::span<Location> locations) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pierce::bench
