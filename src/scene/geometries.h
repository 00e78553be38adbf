// SPDX-License-Identifier: Apache-2.0
//
// The meshes of a scene, their triangles counted through: primitive number <-> (geometry,
// triangle).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bvh/primitives.h"
#include "kernels/kernel.h"
#include "pierce/options.h"
#include "pierce/transform.h"
#include "pierce/types.h"
#include "predicate/types.h"
#include "scene/rounded_image.h"
#include "space/filter_ray.h"
#include "space/filter_space.h"
#include "support/finite.h"

namespace pierce::scene {

/// Of the vertices that triangles use: what filter space is made of. The default is that of none.
struct Extent {
  Vec3<double> lower{std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
  Vec3<double> upper{-lower.x, -lower.y, -lower.z};
  /// Of the magnitudes of coordinates that are not 0.
  double smallest = std::numeric_limits<double>::infinity();
  bool floats = true;  ///< every coordinate is one

  void include(const Vec3<double>& p) {
    floats &= space::is_float(p);
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    for (const double x : {std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) {
      if (x > 0) smallest = std::min(smallest, x);
    }
  }
  void include(const Extent& other) {
    floats &= other.floats;
    lower = {std::min(lower.x, other.lower.x), std::min(lower.y, other.lower.y),
             std::min(lower.z, other.lower.z)};
    upper = {std::max(upper.x, other.upper.x), std::max(upper.y, other.upper.y),
             std::max(upper.z, other.upper.z)};
    smallest = std::min(smallest, other.smallest);
  }
};

template <class Real>
class Geometries final : public bvh::Primitives {
 public:
  Geometries() = default;
  /// Throws Error if a mesh is not valid, there are too many triangles, there are neither no masks
  /// nor one a mesh, or the options say to stop.
  Geometries(std::span<const MeshView<Real>> meshes, const BuildOptions& options);
  /// Of meshes that have been looked at, each in its place: their vertices are transformed when
  /// they are asked for (Instance). Throws Error about numbers of triangles and masks. `extent`:
  /// about the transformed vertices.
  /// `local`: each mesh where it is not placed, as its tree was built over it; kept by the caller.
  Geometries(std::span<const Instance<Real>> placed, std::vector<const Geometries*> local,
             const Extent& extent, const BuildOptions& options);
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

  [[nodiscard]] bvh::Axes across(std::uint32_t primitive, bvh::Axes axes) const override {
    return copies_exact_ ? axes : axes & predicate::axes_across(triangle(primitive));
  }

  /// Of all triangles as the scene has them.
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
  /// And need no examination.
  [[nodiscard]] bool copies_in_order() const { return copies_usable_ && !from_file_; }
  /// The leaves of the scene's tree keep no copies.
  void expect_no_copies() { copies_usable_ = false; }
  /// Kernels have copies in other spaces: no ray is exact there.
  void expect_other_spaces() {
    copies_usable_ = copies_exact_ = false;
    affine_map_ = space_.affine_map(false);
  }
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
    return (mask & mask_of(primitive)) != 0;
  }
  /// Of the triangle's geometry.
  [[nodiscard]] std::uint32_t mask_of(std::uint32_t primitive) const {
    check(primitive);
    return masks_.empty() ? kAllBits : masks_[geometry_of(primitive)];
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
    if (is_placed(geometry)) [[unlikely]]
      return placed_triangle(mesh, transforms_[geometry], t);
    return {predicate::to_double(mesh.vertices[t[0]]), predicate::to_double(mesh.vertices[t[1]]),
            predicate::to_double(mesh.vertices[t[2]])};
  }
  /// Its vertices where they lie, unless they are to be transformed or examined.
  [[nodiscard]] std::optional<std::array<const Vec3<Real>*, 3>> vertices_in_place(
      std::uint32_t primitive) const {
    const std::uint32_t geometry = geometry_of(primitive);
    if (from_file_ || is_placed(geometry)) [[unlikely]]
      return {};
    const MeshView<Real>& mesh = meshes_[geometry];
    const Triangle& t = mesh.triangles[primitive - first_[geometry]];
    return {{&mesh.vertices[t[0]], &mesh.vertices[t[1]], &mesh.vertices[t[2]]}};
  }
  /// Whether the vertices of the mesh are yet to be transformed.
  [[nodiscard]] bool is_placed(std::uint32_t geometry) const {
    return !transforms_.empty() && transforms_[geometry] != Transform<Real>{};
  }
  /// Whether it is of instances that share meshes.
  [[nodiscard]] bool shares_meshes() const { return !transforms_.empty(); }
  /// A vertex as the scene has it.
  [[nodiscard]] Vec3<Real> vertex(std::uint32_t geometry, std::uint32_t number) const {
    const Vec3<Real>& p = meshes_[geometry].vertices[number];
    return is_placed(geometry) ? rounded_image(transforms_[geometry], p) : p;
  }
  /// Whether this component of a point in filter space is exactly that of a point of the scene,
  /// where copies are exact.
  [[nodiscard]] bool is_in_place(double in_scene, float in_filter_space) const {
    return copies_exact_ && space_.unmap_exact(in_filter_space, 0, 0).x == in_scene;
  }
  /// Whether an exact ray has lost nothing of this origin and direction: a component that is 0 is 0
  /// there, too.
  [[nodiscard]] bool is_whole(const Vec3<double>& origin, const Vec3<double>& direction,
                              const space::FilterRay& ray) const {
    const auto zeros = [](double x, float y) { return (x == 0) == (y == 0); };
    return is_in_place(origin.x, ray.origin[0]) && is_in_place(origin.y, ray.origin[1]) &&
           is_in_place(origin.z, ray.origin[2]) && zeros(direction.x, ray.direction[0]) &&
           zeros(direction.y, ray.direction[1]) && zeros(direction.z, ray.direction[2]);
  }
  /// The same for a triangle that a kernel met: from its copy in the leaf where that is exact (and
  /// kept), which spares two look-ups in cold memory.
  [[nodiscard]] predicate::TriangleD triangle(const kernels::Candidate& candidate) const {
    return copies_usable_ ? copied_triangle(candidate) : other_triangle(candidate);
  }

  /// Whether hits of two triangles that a kernel met have the same t at first sight: these have the
  /// same corners, or lie in one plane that stands across an axis, or are hit in the same corner or
  /// on the same edge.
  [[nodiscard]] bool surely_tie(const kernels::Candidate& p, const kernels::Candidate& q) const {
    const auto tie = [&](const auto& a, const auto& b) {
      const auto corners_of = [](const auto& t) {
        return [&t](int k) { return k == 0 ? t.a : k == 1 ? t.b : t.c; };
      };
      return predicate::meet_in_shared_feature(corners_of(a), p.zeros, corners_of(b), q.zeros) ||
             predicate::same_corners(a, b) || predicate::share_plane_across_axis(a, b);
    };
    if (!copies_usable_) return tie(triangle(p.primitive), triangle(q.primitive));
    struct Copies {
      Vec3<float> a, b, c;
      explicit Copies(const kernels::Candidate& of)
          : a(of.corner(0)), b(of.corner(1)), c(of.corner(2)) {}
    };
    return tie(Copies(p), Copies(q));
  }

  /// Whether a triangle has these corners of another one.
  [[nodiscard]] bool has_corners(const kernels::Candidate& candidate, const kernels::Candidate& of,
                                 predicate::Support support) const {
    const auto p = vertices_in_place(of.primitive), q = vertices_in_place(candidate.primitive);
    if (!p || !q) return predicate::has_corners(triangle(candidate), triangle(of), support);
    const auto has = [&q](const Vec3<Real>* corner) {
      return std::any_of(q->begin(), q->end(), [corner](const Vec3<Real>* own) {
        return own == corner || *own == *corner;  // mostly the same one, not to be looked at
      });
    };
    return has((*p)[support.first]) && has((*p)[support.last]);
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

  void count_triangles();

  /// Of a candidate whose copy is usable.
  [[nodiscard, gnu::always_inline]] predicate::TriangleD copied_triangle(
      const kernels::Candidate& candidate) const {
    const auto corner = [&](std::uint32_t row) {
      const float* copy = candidate.copy + row * candidate.stride;
      return space_.unmap_exact(copy[0], copy[candidate.stride], copy[2 * candidate.stride]);
    };
    const predicate::TriangleD t = {corner(0), corner(3), corner(6)};
    if (from_file_) [[unlikely]]
      check(t);
    return t;
  }
  // Of a candidate whose copy is not usable, unless in its mesh.
  [[nodiscard]] predicate::TriangleD other_triangle(const kernels::Candidate& candidate) const {
    if (candidate.copy != nullptr && shares_meshes()) {
      const std::uint32_t geometry = geometry_of(candidate.primitive);
      const Geometries& mesh = *local_[geometry];
      if (mesh.copies_usable_) {
        const predicate::TriangleD t = mesh.copied_triangle(candidate);
        if (!is_placed(geometry)) return t;
        const auto place = [&](const Vec3<double>& p) {
          return predicate::to_double(rounded_image(
              transforms_[geometry],
              {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)}));
        };
        return {place(t.a), place(t.b), place(t.c)};
      }
    }
    return triangle(candidate.primitive);
  }
  [[nodiscard]] static predicate::TriangleD placed_triangle(const MeshView<Real>& mesh,
                                                            const Transform<Real>& transform,
                                                            const Triangle& t) {
    return {predicate::to_double(rounded_image(transform, mesh.vertices[t[0]])),
            predicate::to_double(rounded_image(transform, mesh.vertices[t[1]])),
            predicate::to_double(rounded_image(transform, mesh.vertices[t[2]]))};
  }
  [[nodiscard]] std::uint32_t geometry_of(std::uint32_t primitive) const {
    if (meshes_.size() == 1) return 0;
    // The last mesh that starts at or before it; empty meshes start where the next one does.
    const std::uint32_t run = primitive >> run_bits_;
    const auto next = std::upper_bound(first_.begin() + run_first_[run],
                                       first_.begin() + run_first_[run + 1], primitive);
    return static_cast<std::uint32_t>(next - first_.begin()) - 1;
  }

  std::vector<MeshView<Real>> meshes_;
  std::vector<Transform<Real>> transforms_;  // none, or one a mesh
  std::vector<const Geometries*> local_;     // likewise
  std::vector<std::uint32_t> first_ = {0};   // first_[g]: number of the first triangle of mesh g
  // Of every 2^run_bits_ primitives: before which entry of first_ to look, and from which one on
  // not.
  std::vector<std::uint32_t> run_first_;
  int run_bits_ = 0;
  std::vector<std::uint32_t> masks_;               // one a mesh; none: all bits
  std::vector<std::uint32_t> kinds_ = {kAllBits};  // each mask that occurs, once
  bool hidden_ = false;                            // some mesh has mask 0: no ray sees it
  Extent extent_;
  space::FilterSpace space_;
  space::AffineMap affine_map_;
  bool copies_exact_ = false;   // every float copy in filter space is the exact image of its vertex
  bool copies_usable_ = false;  // and it stays where a candidate says
  bool from_file_ = false;
  std::string file_;
};

}  // namespace pierce::scene
