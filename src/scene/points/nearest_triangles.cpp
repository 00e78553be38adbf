// SPDX-License-Identifier: Apache-2.0
//
// The nearest triangles, several of them: those that bounds cannot exclude are collected, then put
// in order exactly.
#include <algorithm>
#include <cstddef>
#include <queue>
#include <string>
#include <vector>

#include "bvh/leaf_access.h"
#include "kernels/points/axis.h"
#include "predicate/nearest.h"
#include "scene/points/point_distance.h"
#include "scene/scene_impl.h"
#include "scene/two_level.h"
#include "scene/validate_input.h"
#include "support/finite.h"
#include "support/float_environment.h"

namespace pierce {
namespace {

// What bounds leave of the search.
template <class Real>
class NearestSearch {
 public:
  struct Found {
    predicate::NearTriangle near;
    std::uint32_t primitive;
  };

  /// In a tree over the scene's triangles, or in two levels. `repeats`: a triangle may stand in
  /// several leaves.
  NearestSearch(const scene::Geometries<Real>& geometries, const bvh::Tree& tree,
                const scene::TwoLevel<Real>* two_level, bool repeats, const Vec3<double>& point,
                std::uint64_t most, double radius)
      : geometries_(geometries),
        tree_(two_level == nullptr ? tree : two_level->top()),
        two_level_(two_level),
        repeats_(repeats),
        most_(most),
        point_(point),
        radius_(radius),
        distance_(geometries.space(),
                  {geometries.space().map(point), geometries.space().direction_of(point),
                   geometries.space().map_length(radius)}),
        limit_(distance_.limit()) {
    if (most == 0 || tree_.root == bvh::kNoChild) return;
    todo_.push({-kInfinity<double>, tree_.root, nullptr});
    while (!todo_.empty()) {
      const Todo next = todo_.top();
      todo_.pop();
      if (next.distance > limit_) break;  // and so are all the others
      if (!bvh::is_leaf(next.ref)) {
        open(next);
      } else if (two_level != nullptr && next.placed == nullptr) {
        const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree_, next.ref);
        for (std::uint32_t i = 0; i < bvh::leaf_count(next.ref); ++i) {
          const scene::Placed& placed = two_level->placed(numbers[i]);
          todo_.push({next.distance, two_level->bottom(placed).tree.root, &placed});
        }
      } else {
        look_at(next);
      }
    }
  }

  [[nodiscard]] std::vector<Found>& found() { return found_; }
  [[nodiscard]] predicate::LadderCounts& counts() { return counts_; }

 private:
  struct Todo {
    double distance;
    std::uint32_t ref;
    const scene::Placed* placed;  // null: of the tree that was begun with
    bool operator<(const Todo& other) const { return distance > other.distance; }
  };

  [[nodiscard]] const bvh::Tree& tree_of(const Todo& todo) const {
    return todo.placed == nullptr ? tree_ : two_level_->bottom(*todo.placed).tree;
  }

  void look_at(const Todo& leaf) {
    const std::uint32_t first = leaf.placed == nullptr ? 0 : leaf.placed->first;
    const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree_of(leaf), leaf.ref);
    for (std::uint32_t i = 0; i < bvh::leaf_count(leaf.ref); ++i) {
      const std::uint32_t primitive = first + numbers[i];
      if (repeats_ && !met_.add(primitive)) continue;
      found_.push_back(
          {predicate::decide_near(point_, geometries_.triangle(primitive), counts_), primitive});
      note(found_.back().near);
    }
  }

  void open(const Todo& todo) {
    const bvh::Node& node = tree_of(todo).nodes[todo.ref];
    for (int child = 0; child < bvh::kWidth && node.child[child] != bvh::kNoChild; ++child) {
      const double distance = distance_.to(scene::middle_box(node, child), 0x1p-50, todo.placed);
      if (distance <= limit_) todo_.push({distance, node.child[child], todo.placed});
    }
  }

  // Lowers the limit to what the triangle tells.
  void note(const predicate::NearTriangle& near) {
    const double beyond = distance_.beyond(near);
    if (distance_.is_far() && !predicate::decide_within(point_, near, radius_, counts_)) {
      limit_ = std::min(limit_, beyond);
    }
    if (most_ == kUnlimited) return;
    if (beyonds_.size() == most_) {
      if (beyond >= beyonds_.top()) return;
      beyonds_.pop();
    }
    beyonds_.push(beyond);
    if (beyonds_.size() == most_) limit_ = std::min(limit_, beyonds_.top());
  }

  const scene::Geometries<Real>& geometries_;
  const bvh::Tree& tree_;
  const scene::TwoLevel<Real>* two_level_;
  const bool repeats_;
  const std::uint64_t most_;
  const Vec3<double> point_;
  const double radius_;
  const scene::PointDistance distance_;
  double limit_;
  std::priority_queue<Todo> todo_;
  std::priority_queue<double> beyonds_;  // of the nearest ones, so many
  kernels::MetTriangles met_;
  std::vector<Found> found_;
  predicate::LadderCounts counts_;
};

// The distance, squared, that surely as many triangles as are wanted have or are below.
template <class Found>
double enough_of(const std::vector<Found>& found, std::uint64_t most) {
  if (most == 0 || found.size() <= most) return kInfinity<double>;
  std::vector<double> highs;
  highs.reserve(found.size());
  for (const Found& one : found) highs.push_back(one.near.squared.high);
  const auto last = highs.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(highs.begin(), last, highs.end());
  return *last;
}

}  // namespace

template <class Real>
void Scene<Real>::nearest_triangles(const Vec3<Real>& point, std::uint64_t most,
                                    std::vector<NearestPoint<Real>>& out, Real radius) const {
  const FloatEnvironment environment;
  scene::validate_point(point);
  if (!(radius >= 0)) {
    throw Error(ErrorCode::InvalidArgument,
                std::string("the radius ") + (is_nan(radius) ? "is not a number" : "is negative") +
                    "; give 0 or more, or infinity for no limit");
  }
  const Vec3<double> p = predicate::to_double(point);
  const scene::Geometries<Real>& geometries = impl_->geometries;
  const bool shared = geometries.shares_meshes();
  NearestSearch<Real> search(geometries, impl_->tree, shared ? impl_->two_level.get() : nullptr,
                             shared || impl_->surface->repeats(impl_->tree, geometries.size()), p,
                             most, static_cast<double>(radius));
  using Found = typename NearestSearch<Real>::Found;
  std::vector<Found>& found = search.found();
  const double enough = enough_of(found, most);
  std::erase_if(found, [&](const Found& one) {
    return one.near.squared.low > enough ||
           !predicate::decide_within(p, one.near, static_cast<double>(radius), search.counts());
  });
  const auto nearer = [&](const Found& a, const Found& b) {
    const auto order = predicate::decide_nearer(p, a.near, b.near, search.counts());
    return order != 0 ? order < 0 : a.primitive < b.primitive;
  };
  if (found.size() > most) {
    const auto wanted = static_cast<std::ptrdiff_t>(most);
    std::nth_element(found.begin(), found.begin() + wanted, found.end(), nearer);
    found.resize(static_cast<std::size_t>(most));
  }
  std::sort(found.begin(), found.end(), nearer);
  out.clear();
  out.reserve(found.size());
  for (const Found& one : found) {
    NearestPoint<Real> result = predicate::round_nearest<Real>(p, one.near, search.counts());
    const TriangleRef ref = geometries.ref(one.primitive);
    result.geometry = ref.geometry;
    result.triangle = ref.triangle;
    out.push_back(environment.made(result));
  }
}

template void Scene<float>::nearest_triangles(const Vec3<float>&, std::uint64_t,
                                              std::vector<NearestPoint<float>>&, float) const;
template void Scene<double>::nearest_triangles(const Vec3<double>&, std::uint64_t,
                                               std::vector<NearestPoint<double>>&, double) const;

}  // namespace pierce
