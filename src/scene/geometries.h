// SPDX-License-Identifier: Apache-2.0
//
// The meshes of a scene, their triangles counted through: primitive number <-> (geometry,
// triangle).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/filter_space.h"
#include "bvh/primitives.h"
#include "kernels/kernel.h"
#include "pierce/options.h"
#include "pierce/types.h"
#include "predicate/types.h"

namespace pierce::scene {

template <class Real>
class Geometries final : public bvh::Primitives {
 public:
  Geometries() = default;
  /// Throws Error if a mesh is not valid, there are too many triangles or the options say to stop.
  Geometries(std::span<const MeshView<Real>> meshes, const BuildOptions& options);

  [[nodiscard]] std::uint32_t size() const override { return first_.back(); }
  [[nodiscard]] bvh::Corners corners(std::uint32_t primitive) const override {
    const predicate::TriangleD t = triangle(primitive);
    return {space_.map(t.a), space_.map(t.b), space_.map(t.c)};
  }

  void gather(const std::uint32_t* numbers, std::uint32_t n, bvh::Corners* out) const override {
    for (std::uint32_t i = 0; i < n; ++i) out[i] = corners(numbers[i]);
  }

  [[nodiscard]] const bvh::FilterSpace& space() const { return space_; }
  [[nodiscard]] bool copies_exact() const { return copies_exact_; }
  /// The leaves of the scene's tree keep no copies.
  void expect_no_copies() { copies_usable_ = false; }
  [[nodiscard]] std::span<const MeshView<Real>> meshes() const { return meshes_; }

  [[nodiscard]] TriangleRef ref(std::uint32_t primitive) const {
    const std::uint32_t geometry = geometry_of(primitive);
    return {geometry, primitive - first_[geometry]};
  }
  /// kNone if there is no such triangle.
  [[nodiscard]] std::uint32_t primitive(const TriangleRef& ref) const {
    if (ref.geometry >= meshes_.size() || ref.triangle >= meshes_[ref.geometry].triangles.size()) {
      return kNone;
    }
    return first_[ref.geometry] + ref.triangle;
  }
  [[nodiscard]] predicate::TriangleD triangle(std::uint32_t primitive) const {
    const std::uint32_t geometry = geometry_of(primitive);
    const MeshView<Real>& mesh = meshes_[geometry];
    const Triangle& t = mesh.triangles[primitive - first_[geometry]];
    return {predicate::to_double(mesh.vertices[t[0]]), predicate::to_double(mesh.vertices[t[1]]),
            predicate::to_double(mesh.vertices[t[2]])};
  }
  /// The same for a triangle that a kernel met: from its copy in the leaf where that is exact (and
  /// kept), which spares two look-ups in cold memory.
  [[nodiscard]] predicate::TriangleD triangle(const kernels::Candidate& candidate) const {
    if (!copies_usable_) return triangle(candidate.primitive);
    const auto corner = [&](std::uint32_t row) {
      const float* copy = candidate.copy + row * candidate.stride;
      return space_.unmap_exact(copy[0], copy[candidate.stride], copy[2 * candidate.stride]);
    };
    return {corner(0), corner(3), corner(6)};
  }

 private:
  [[nodiscard]] std::uint32_t geometry_of(std::uint32_t primitive) const {
    if (meshes_.size() == 1) return 0;
    // The last mesh that starts at or before it; empty meshes start where the next one does.
    const auto next = std::upper_bound(first_.begin(), first_.end(), primitive);
    return static_cast<std::uint32_t>(next - first_.begin()) - 1;
  }

  std::vector<MeshView<Real>> meshes_;
  std::vector<std::uint32_t> first_ = {0};  // first_[g]: number of the first triangle of mesh g
  bvh::FilterSpace space_;
  bool copies_exact_ = false;   // every float copy in filter space is the exact image of its vertex
  bool copies_usable_ = false;  // and it stays where a candidate says
};

}  // namespace pierce::scene
