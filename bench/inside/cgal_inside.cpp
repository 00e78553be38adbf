// SPDX-License-Identifier: Apache-2.0
//
// In a file of its own: CGAL wants flags of its own.
#include "inside/cgal_inside.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace pierce::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Side = CGAL::Side_of_triangle_mesh<Surface, Kernel>;

Kernel::Point_3 to_point(const Vec3<float>& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Surface surface_of(MeshView<float> mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  std::vector<Kernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& p : mesh.vertices) points.push_back(to_point(p));
  for (const Triangle& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) {
    throw std::runtime_error("CGAL: not a manifold mesh");
  }
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

}  // namespace

struct CgalInside::Impl {
  Surface surface;
  Side side;

  explicit Impl(MeshView<float> mesh) : surface(surface_of(mesh)), side(surface) {}
};

CgalInside::CgalInside(MeshView<float> mesh) : impl_(std::make_unique<Impl>(mesh)) {
  if (!mesh.vertices.empty()) (void)impl_->side(to_point(mesh.vertices[0]));  // builds its tree
}

CgalInside::~CgalInside() = default;

void CgalInside::locate(std::span<const Vec3<float>> points, std::span<Location> locations) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    switch (impl_->side(to_point(points[i]))) {
      case CGAL::ON_BOUNDED_SIDE:
        locations[i] = Location::Inside;
        break;
      case CGAL::ON_BOUNDARY:
        locations[i] = Location::OnSurface;
        break;
      case CGAL::ON_UNBOUNDED_SIDE:
        locations[i] = Location::Outside;
        break;
    }
  }
}

}  // namespace pierce::bench
