// SPDX-License-Identifier: Apache-2.0
#include "scene/geometries.h"

#include <cmath>
#include <limits>
#include <string>

#include "kernels/filter_ray.h"
#include "scene/validate_input.h"

namespace pierce::scene {
namespace {

struct Bounds {
  Vec3<double> lower{std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
  Vec3<double> upper{-lower.x, -lower.y, -lower.z};
  double smallest = std::numeric_limits<double>::infinity();  // of the magnitudes that are not 0
  bool floats = true;                                         // all of them are

  void include(const Vec3<double>& p) {
    floats &= kernels::is_float(p);
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    for (const double x : {std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) {
      if (x > 0) smallest = std::min(smallest, x);
    }
  }
};

}  // namespace

template <class Real>
Geometries<Real>::Geometries(std::span<const MeshView<Real>> meshes,
                             std::span<const std::uint32_t> masks)
    : meshes_(meshes.begin(), meshes.end()), masks_(masks.begin(), masks.end()) {
  if (!masks.empty()) {
    if (masks.size() != meshes.size()) {
      throw Error(ErrorCode::SizeMismatch,
                  "there are " + std::to_string(meshes.size()) + " geometries but " +
                      std::to_string(masks.size()) + " masks: " +
                      (masks.size() < meshes.size()
                           ? "geometry " + std::to_string(masks.size()) + " has none"
                           : "there is no geometry " + std::to_string(meshes.size())) +
                      "; give none, or one a geometry");
    }
    kinds_ = masks_;
    std::ranges::sort(kinds_);
    kinds_.erase(std::ranges::unique(kinds_).begin(), kinds_.end());
    hidden_ = kinds_.front() == 0;
  }
  std::uint64_t count = 0;
  Bounds bounds;
  for (std::size_t geometry = 0; geometry < meshes.size(); ++geometry) {
    const MeshView<Real>& mesh = meshes[geometry];
    count += mesh.triangles.size();
    if (count >= kNone) {
      throw Error(ErrorCode::TooManyTriangles,
                  "too many triangles: at most " + std::to_string(kNone - 1) +
                      " fit in one scene; split the meshes over several");
    }
    validate_mesh(mesh, geometry, meshes.size());
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t vertex : t) {
        bounds.include(predicate::to_double(mesh.vertices[vertex]));
      }
    }
    first_.push_back(static_cast<std::uint32_t>(count));
  }
  space_ = bvh::FilterSpace(bounds.lower, bounds.upper);
  // Doubles are often floats that were widened on their way.
  copies_usable_ = copies_exact_ = bounds.floats && space_.maps_floats_exactly(bounds.smallest);
}

template class Geometries<float>;
template class Geometries<double>;

}  // namespace pierce::scene
