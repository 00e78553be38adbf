// SPDX-License-Identifier: Apache-2.0
//
// CGAL's AABB tree over exact predicates and inexact constructions: the closest point, one by one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "pierce/types.h"

namespace pierce::bench {

class CgalNearest {
 public:
  explicit CgalNearest(MeshView<float> mesh);
  ~CgalNearest();
  CgalNearest(const CgalNearest&) = delete;
  CgalNearest& operator=(const CgalNearest&) = delete;

  /// The triangle of the closest point of each.
  void closest(std::span<const Vec3<float>> points, std::span<std::uint32_t> triangles) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pierce::bench
