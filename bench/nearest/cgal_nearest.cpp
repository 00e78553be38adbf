// SPDX-License-Identifier: Apache-2.0
//
// In a file of its own: CGAL wants flags of its own.
#include "nearest/cgal_nearest.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <vector>

namespace pierce::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_point(const Vec3<float>& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Triangles triangles_of(MeshView<float> mesh) {
  Triangles triangles;
  for (const Triangle& t : mesh.triangles) {
    triangles.emplace_back(to_point(mesh.vertices[t[0]]), to_point(mesh.vertices[t[1]]),
                           to_point(mesh.vertices[t[2]]));
  }
  return triangles;
}

}  // namespace

struct CgalNearest::Impl {
  Triangles triangles;
  Tree tree;

  explicit Impl(MeshView<float> mesh)
      : triangles(triangles_of(mesh)), tree(triangles.begin(), triangles.end()) {
    tree.build();
    tree.accelerate_distance_queries();
  }
};

CgalNearest::CgalNearest(MeshView<float> mesh) : impl_(std::make_unique<Impl>(mesh)) {}
CgalNearest::~CgalNearest() = default;

void CgalNearest::closest(std::span<const Vec3<float>> points,
                          std::span<std::uint32_t> triangles) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = impl_->tree.closest_point_and_primitive(to_point(points[i]));
    triangles[i] = static_cast<std::uint32_t>(found.second - impl_->triangles.begin());
  }
}

}  // namespace pierce::bench
