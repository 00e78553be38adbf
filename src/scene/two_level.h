// SPDX-License-Identifier: Apache-2.0
//
// Instances that share the trees of their meshes: one tree a mesh, in a filter space of its own,
// and a top tree over the places where these stand. The triangles that queries decide about are
// those that a flat scene would have, their vertices transformed and rounded when they are asked
// for; the trees only say which to ask (docs/decisions/0024-two-levels.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bvh/point_traversal.h"
#include "bvh/tree.h"
#include "pierce/mesh.h"
#include "pierce/options.h"
#include "pierce/transform.h"
#include "scene/geometries.h"
#include "space/local_space.h"

namespace pierce::scene {

/// A mesh in its own coordinates.
template <class Real>
struct Bottom {
  Geometries<Real> geometries;  // none, if it is a part of the scene and has the scene's numbers
  bvh::Tree tree;

  Bottom(const MeshView<Real>& mesh, const BuildOptions& options);
  explicit Bottom(bvh::Tree of_part) : tree(std::move(of_part)) {}
};

/// Where one stands. What a ray needs of it is in the first three cache lines.
struct alignas(64) Placed {
  std::uint32_t bottom;
  std::uint32_t first;  // the number of its first triangle, counted over the scene
  std::uint32_t count;  // of triangles; kNone if these have the scene's numbers (`first` is 0)
  space::LocalSpace space;

  /// A triangle of the scene as the tree has it; kNone if it is another's.
  [[nodiscard]] std::uint32_t local(std::uint32_t primitive) const {
    return primitive >= first && primitive - first < count ? primitive - first : kNone;
  }
};

/// A box of a tree: its planes lie `stride` numbers apart.
[[nodiscard]] inline space::MiddleBox middle_box(const float* lower, const float* upper,
                                                 std::size_t stride) {
  const auto middle = [&](std::size_t k) {
    return 0.5 * (static_cast<double>(lower[k * stride]) + static_cast<double>(upper[k * stride]));
  };
  // Both are exact: floats of like magnitude.
  const auto half = [&](std::size_t k) {
    return 0.5 * (static_cast<double>(upper[k * stride]) - static_cast<double>(lower[k * stride]));
  };
  return {{middle(0), middle(1), middle(2)}, {half(0), half(1), half(2)}};
}

/// The box of a child.
[[nodiscard]] inline space::MiddleBox middle_box(const bvh::Node& node, int child) {
  return middle_box(&node.lower[0][child], &node.upper[0][child], bvh::kWidth);
}

template <class Real>
class TwoLevel {
 public:
  TwoLevel() = default;
  /// Of instances as they are, except that of some the vertices have been transformed already,
  /// being no good otherwise: these are replaced. `baked` has room for one mesh an instance and is
  /// filled for those. Throws what Scene::build throws. Nothing else may be asked of one that is
  /// not `usable`.
  TwoLevel(std::span<Instance<Real>> instances, std::span<Mesh<Real>> baked,
           const BuildOptions& options);

  /// Of parts of a scene, each in a space of its own.
  TwoLevel(const Geometries<Real>& scene, const std::vector<std::vector<std::uint32_t>>& parts,
           const BuildOptions& options);

  /// The triangles of the scene; as Scene has them. Of instances.
  [[nodiscard]] Geometries<Real> geometries(std::span<const Instance<Real>> instances,
                                            const BuildOptions& options) const;

  /// If not, two levels do not serve these: a flat scene has to.
  [[nodiscard]] bool usable() const { return usable_; }
  [[nodiscard]] const bvh::Tree& top() const { return top_; }
  [[nodiscard]] const Placed& placed(std::uint32_t number) const { return placed_[number]; }
  /// That of leaf k of the top tree is the k-th.
  [[nodiscard]] std::span<const Placed> all_placed() const { return placed_; }
  [[nodiscard]] std::size_t places() const { return placed_.size(); }
  [[nodiscard]] const Bottom<Real>& bottom(const Placed& placed) const {
    return *bottoms_[placed.bottom];
  }
  [[nodiscard]] std::span<const std::unique_ptr<Bottom<Real>>> bottoms() const { return bottoms_; }
  [[nodiscard]] std::uint64_t bytes() const;
  /// Whether rays of a block had better go together: through parts of a scene, or if they wait for
  /// memory, the trees of instances being larger than a core's cache.
  [[nodiscard]] bool goes_together() const {
    return bottom_of_.empty() || bytes_below_ > std::size_t{4} << 20;
  }

  /// Calls `visit(primitive)` for every triangle of a place, until it returns true; returns whether
  /// it did. A triangle may be visited twice.
  template <class Visit>
  bool for_each_triangle(const Placed& there, const Visit& visit) const {
    constexpr double kAll = 16;
    return bvh::traverse_box(bottom(there).tree, {-kAll, -kAll, -kAll}, {kAll, kAll, kAll},
                             [&](std::uint32_t local) { return visit(there.first + local); });
  }

  /// Calls `visit(primitive)` for every triangle that may meet the box, given in the scene's filter
  /// space, until it returns true; returns whether it did. A triangle may be visited twice.
  template <class Visit>
  bool traverse_box(const Vec3<double>& lower, const Vec3<double>& upper,
                    const Visit& visit) const {
    return bvh::traverse_box(top_, lower, upper, [&](std::uint32_t number) {
      const Placed& there = placed_[number];
      const auto middle = [](double p, double q) { return 0.5 * (p + q); };
      const auto half = [](double p, double q) { return 0.5 * (q - p) + 0x1p-50 * (q - p); };
      const space::MiddleBox box = there.space.to_local(
          {{middle(lower.x, upper.x), middle(lower.y, upper.y), middle(lower.z, upper.z)},
           {half(lower.x, upper.x), half(lower.y, upper.y), half(lower.z, upper.z)}});
      const Vec3<double>&m = box.middle, &h = box.half;
      return bvh::traverse_box(bottom(there).tree, {m.x - h.x, m.y - h.y, m.z - h.z},
                               {m.x + h.x, m.y + h.y, m.z + h.z},
                               [&](std::uint32_t local) { return visit(there.first + local); });
    });
  }

  /// Calls `visit(primitive)` for every triangle of every leaf that is in boxes, given in the
  /// scene's filter space, of which `may_meet(box)` is true. A triangle may be visited twice.
  template <class MayMeet, class Visit>
  void traverse_where(const MayMeet& may_meet, const Visit& visit) const {
    const auto above = [&](const bvh::Node& node, int child) {
      return may_meet(middle_box(node, child));
    };
    bvh::traverse_where(top_, above, [&](std::uint32_t number) {
      const Placed& there = placed_[number];
      const auto below = [&](const bvh::Node& node, int child) {
        return may_meet(there.space.to_scene(middle_box(node, child)));
      };
      return bvh::traverse_where(bottom(there).tree, below, [&](std::uint32_t local) {
        visit(there.first + local);
        return false;
      });
    });
  }

 private:
  // Builds the top tree over the boxes of all that are placed, and puts these in the order of its
  // leaves.
  void build_top(const bvh::Primitives& boxes, const WorkOptions& work);

  std::vector<std::unique_ptr<Bottom<Real>>> bottoms_;
  std::vector<Placed> placed_;            // those with triangles
  std::vector<std::uint32_t> bottom_of_;  // of every instance, if these are any
  Extent extent_;
  std::size_t bytes_below_ = 0;  // of the trees of bottoms_
  bvh::Tree top_;
  bool usable_ = true;
};

/// Whether these are to share their meshes' trees, by what a flat scene would cost beyond that.
template <class Real>
bool are_to_share(std::span<const Instance<Real>> instances, const BuildOptions& options);

extern template struct Bottom<float>;
extern template struct Bottom<double>;
extern template class TwoLevel<float>;
extern template class TwoLevel<double>;

}  // namespace pierce::scene
