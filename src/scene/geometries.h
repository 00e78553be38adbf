// SPDX-License-Identifier: Apache-2.0
//
// The meshes of a scene, their triangles counted through: primitive number <-> (geometry,
// triangle).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bvh/primitives.h"
#include "kernels/kernel.h"
#include "pierce/options.h"
#include "pierce/types.h"
#include "predicate/types.h"
#include "space/filter_space.h"
#include "support/finite.h"

namespace pierce::scene {

/// Of the vertices that triangles use: what filter space is made of.
struct Extent {
  Vec3<double> lower, upper;
  double smallest;  ///< of the magnitudes of coordinates that are not 0
  bool floats;      ///< every coordinate is one
};

template <class Real>
class Geometries final : public bvh::Primitives {
 public:
  Geometries() = default;
  /// Throws Error if a mesh is not valid, there are too many triangles, there are neither no masks
  /// nor one a mesh, or the options say to stop.
  Geometries(std::span<const MeshView<Real>> meshes, const BuildOptions& options);
  /// Of a file, of which nothing but this extent is known: indices and coordinates are looked at
  /// as queries meet them, and a bad one is Error (BadFile) with the name.
  Geometries(std::span<const MeshView<Real>> meshes, std::span<const std::uint32_t> masks,
             const Extent& extent, std::string file);

  [[nodiscard]] std::uint32_t size() const override { return first_.back(); }
  [[nodiscard]] bvh::Corners corners(std::uint32_t primitive) const override {
    const predicate::TriangleD t = triangle(primitive);
    return {space_.map(t.a), space_.map(t.b), space_.map(t.c)};
  }

  void gather(const std::uint32_t* numbers, std::uint32_t n, bvh::Corners* out) const override {
    for (std::uint32_t i = 0; i < n; ++i) out[i] = corners(numbers[i]);
  }

  [[nodiscard]] const Extent& extent() const { return extent_; }
  /// Throws Error if the meshes, being those of a file, are not valid.
  void examine() const;
  [[nodiscard]] const space::FilterSpace& space() const { return space_; }
  [[nodiscard]] bool copies_exact() const { return copies_exact_; }
  /// Whether rays of floats are transformed by scaling: exact copies, by a scale that is a float.
  [[nodiscard]] bool only_scaled() const { return copies_exact_ && !is_nan(space_.float_scale()); }
  [[nodiscard]] const space::AffineMap& affine_map() const { return affine_map_; }
  /// The same, and a candidate's copy is where it says.
  [[nodiscard]] bool copies_usable() const { return copies_usable_; }
  /// The leaves of the scene's tree keep no copies.
  void expect_no_copies() { copies_usable_ = false; }
  [[nodiscard]] std::span<const MeshView<Real>> meshes() const { return meshes_; }
  /// None, or one a mesh.
  [[nodiscard]] std::span<const std::uint32_t> masks() const { return masks_; }

  [[nodiscard]] TriangleRef ref(std::uint32_t primitive) const {
    check(primitive);
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
  /// Whether a ray with this mask sees the triangle.
  [[nodiscard]] bool is_seen(std::uint32_t primitive, std::uint32_t mask) const {
    check(primitive);
    return (mask & (masks_.empty() ? kAllBits : masks_[geometry_of(primitive)])) != 0;
  }
  /// Whether it sees every geometry.
  [[nodiscard]] bool all_seen(std::uint32_t mask) const {
    if (mask == kAllBits) return !hidden_;
    return std::all_of(kinds_.begin(), kinds_.end(),
                       [mask](std::uint32_t kind) { return (mask & kind) != 0; });
  }
  [[nodiscard]] predicate::TriangleD triangle(std::uint32_t primitive) const {
    if (from_file_) [[unlikely]]
      return examined(primitive);
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
    const predicate::TriangleD t = {corner(0), corner(3), corner(6)};
    if (from_file_) [[unlikely]]
      check(t);
    return t;
  }

  /// Whether two triangles that a kernel met have the same corners: their hits have the same t.
  [[nodiscard]] bool coincide(const kernels::Candidate& p, const kernels::Candidate& q) const {
    if (!copies_usable_)
      return predicate::same_corners(triangle(p.primitive), triangle(q.primitive));
    struct Copies {
      Vec3<float> a, b, c;
    };
    const auto copies = [](const kernels::Candidate& candidate) {
      const auto corner = [&](std::uint32_t row) {
        const float* copy = candidate.copy + row * candidate.stride;
        return Vec3<float>{copy[0], copy[candidate.stride], copy[2 * candidate.stride]};
      };
      return Copies{corner(0), corner(3), corner(6)};
    };
    return predicate::same_corners(copies(p), copies(q));
  }

  /// Prefetches the index triples, then the vertices of the candidates.
  void prefetch(std::span<const kernels::Candidate> candidates) const {
    if (copies_usable_) return;
    const auto indices = [this](std::uint32_t primitive) {
      const std::uint32_t geometry = geometry_of(primitive);
      return &meshes_[geometry].triangles[primitive - first_[geometry]];
    };
    for (const kernels::Candidate& candidate : candidates) {
      if (candidate.primitive < size()) __builtin_prefetch(indices(candidate.primitive));
    }
    for (const kernels::Candidate& candidate : candidates) {
      if (candidate.primitive >= size()) continue;  // none, or a damaged file's
      const Vec3<Real>* vertices = meshes_[geometry_of(candidate.primitive)].vertices.data();
      for (const std::uint32_t corner : *indices(candidate.primitive)) {
        __builtin_prefetch(vertices + corner);
      }
    }
  }

 private:
  void set_masks(std::span<const std::uint32_t> masks);
  void set_extent(const Extent& extent);
  // Of what a file says.
  void check(std::uint32_t primitive) const {
    if (from_file_ && primitive >= size()) [[unlikely]]
      refuse("a leaf of the search tree names a triangle that is not there");
  }
  void check(const predicate::TriangleD& t) const;
  [[nodiscard]] predicate::TriangleD examined(std::uint32_t primitive) const;
  [[noreturn]] void refuse(const char* why) const;

  [[nodiscard]] std::uint32_t geometry_of(std::uint32_t primitive) const {
    if (meshes_.size() == 1) return 0;
    // The last mesh that starts at or before it; empty meshes start where the next one does.
    const auto next = std::upper_bound(first_.begin(), first_.end(), primitive);
    return static_cast<std::uint32_t>(next - first_.begin()) - 1;
  }

  std::vector<MeshView<Real>> meshes_;
  std::vector<std::uint32_t> first_ = {0};  // first_[g]: number of the first triangle of mesh g
  std::vector<std::uint32_t> masks_;        // one a mesh; none: all bits
  std::vector<std::uint32_t> kinds_ = {kAllBits};  // each mask that occurs, once
  bool hidden_ = false;                            // some mesh has mask 0: no ray sees it
  space::FilterSpace space_;
  space::AffineMap affine_map_;
  bool copies_exact_ = false;   // every float copy in filter space is the exact image of its vertex
  bool copies_usable_ = false;  // and it stays where a candidate says
  Extent extent_{};
  bool from_file_ = false;
  std::string file_;
};

}  // namespace pierce::scene
