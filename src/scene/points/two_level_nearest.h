// SPDX-License-Identifier: Apache-2.0
//
// The traversal to the nearest triangle in two levels: in double, in the scene's filter space,
// where the boxes of the meshes' trees are brought one by one, for a placement need not keep
// distances. For points so far away that all distances look alike, what counts is how far things
// reach towards the point (kernels/points/nearest_plain.cpp). The nearest first; what a box leaves
// open the ladder decides.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "bvh/leaf_access.h"
#include "kernels/points/nearest.h"
#include "predicate/bounds.h"
#include "scene/points/nearest_resolver.h"
#include "scene/two_level.h"

namespace pierce::scene {

template <class Real>
class TwoLevelNearest {
 public:
  TwoLevelNearest(const TwoLevel<Real>& two_level, const space::FilterSpace& space,
                  const kernels::FilterPoint& point, NearestResolver<Real>& resolver,
                  kernels::KernelCounts* counts)
      : two_level_(two_level),
        space_(space),
        point_(point.position),
        direction_(point.direction),
        size_(std::max({std::fabs(point_.x), std::fabs(point_.y), std::fabs(point_.z)})),
        far_(!(size_ <= bounds::kNearestFarthest)),
        resolver_(resolver),
        counts_(counts),
        limit_(far_ ? kFar : point.limit) {}

  /// As kernels::NearestTraversal, by the scene's number.
  kernels::Candidate run() {
    if (two_level_.top().root == bvh::kNoChild) return best_;
    stack_.push_back({-kFar, two_level_.top().root, nullptr});
    while (!stack_.empty()) {
      const Entry next = stack_.back();
      stack_.pop_back();
      if (next.distance > limit_) continue;
      if (!bvh::is_leaf(next.ref)) {
        visit_node(next);
      } else if (next.placed != nullptr) {
        visit_leaf(next);
      } else {
        const bvh::Tree& top = two_level_.top();
        const bvh::LeafNumber* numbers = bvh::leaf_numbers(top, next.ref);
        for (std::uint32_t i = 0; i < bvh::leaf_count(next.ref); ++i) {
          const Placed& placed = two_level_.placed(numbers[i]);
          stack_.push_back({next.distance, two_level_.bottom(placed).tree.root, &placed});
        }
      }
    }
    return best_;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  struct Entry {
    double distance;
    std::uint32_t ref;
    const Placed* placed;  // null: of the top tree
  };

  // A little less than the distance to anything in the box, or its reach; `placed` says in whose
  // space that is.
  [[nodiscard]] double distance_to(const Vec3<double>& lower, const Vec3<double>& upper,
                                   double more, const Placed* placed) const {
    const auto middle = [](double p, double q) { return 0.5 * (p + q); };
    const auto half = [&](double p, double q) { return 0.5 * (q - p) + more; };
    space::MiddleBox box{
        {middle(lower.x, upper.x), middle(lower.y, upper.y), middle(lower.z, upper.z)},
        {half(lower.x, upper.x), half(lower.y, upper.y), half(lower.z, upper.z)}};
    if (placed != nullptr) box = placed->space.to_scene(box);
    if (far_) {
      const Vec3<double>&m = box.middle, &h = box.half, &d = direction_;
      return -(d.x * m.x + d.y * m.y + d.z * m.z) -
             (std::fabs(d.x) * h.x + std::fabs(d.y) * h.y + std::fabs(d.z) * h.z) -
             bounds::kNearestFar;
    }
    const auto outside = [](double p, double m, double h) {
      return std::max(std::fabs(p - m) - h, 0.0);
    };
    const double x = outside(point_.x, box.middle.x, box.half.x);
    const double y = outside(point_.y, box.middle.y, box.half.y);
    const double z = outside(point_.z, box.middle.z, box.half.z);
    return std::sqrt(x * x + y * y + z * z) - bounds::kNearestPlainReach * (1 + size_);
  }

  void visit_node(const Entry& entry) {
    if (counts_ != nullptr) ++counts_->nodes;
    const bvh::Tree& tree =
        entry.placed == nullptr ? two_level_.top() : two_level_.bottom(*entry.placed).tree;
    const bvh::Node& node = tree.nodes[entry.ref];
    const std::size_t first = stack_.size();
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      const auto at = [i](const float(&planes)[3][bvh::kWidth]) {
        return Vec3<double>{static_cast<double>(planes[0][i]), static_cast<double>(planes[1][i]),
                            static_cast<double>(planes[2][i])};
      };
      const double distance = distance_to(at(node.lower), at(node.upper), 0x1p-50, entry.placed);
      if (distance > limit_) continue;
      // Nearest on top: insertion into the few that this node has pushed.
      std::size_t place = stack_.size();
      stack_.push_back({distance, node.child[i], entry.placed});
      for (; place > first && stack_[place - 1].distance < distance; --place) {
        std::swap(stack_[place - 1], stack_[place]);
      }
    }
  }

  void visit_leaf(const Entry& entry) {
    if (counts_ != nullptr) ++counts_->leaves;
    const std::uint32_t count = bvh::leaf_count(entry.ref);
    bvh::LeafScratch scratch;
    const float* block = bvh::leaf_block(two_level_.bottom(*entry.placed).tree, entry.ref, scratch);
    const float* rows = block + bvh::kLeafHead;
    // What copying the corners to float moves them by.
    const double copied = 0x1p-24 * static_cast<double>(block[1]);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto row = [&](std::uint32_t k) { return static_cast<double>(rows[k * count + i]); };
      const auto low = [&](std::uint32_t k) { return std::min({row(k), row(k + 3), row(k + 6)}); };
      const auto high = [&](std::uint32_t k) { return std::max({row(k), row(k + 3), row(k + 6)}); };
      const double distance = distance_to({low(0), low(1), low(2)}, {high(0), high(1), high(2)},
                                          copied + 0x1p-50, entry.placed);
      if (distance > limit_) continue;
      if (counts_ != nullptr) ++counts_->candidates;
      offer({bvh::number_in(rows, count, i) + entry.placed->first, 0, nullptr});
    }
  }

  void offer(const kernels::Candidate& candidate) {
    if (best_.primitive != kNone && !resolver_.is_nearer(candidate, best_)) return;
    best_ = candidate;
    const predicate::NearTriangle& near = resolver_.near(best_);
    if (!far_) {
      const double distance = std::sqrt(near.squared.high);
      limit_ = std::min(limit_, space_.map_length(distance * (1 + 0x1p-50)));
      return;
    }
    for (const Vec3<double>& corner : {near.triangle.a, near.triangle.b, near.triangle.c}) {
      const Vec3<double> p = space_.map(corner);
      const double reach = -(direction_.x * p.x + direction_.y * p.y + direction_.z * p.z);
      limit_ = std::min(limit_, reach + bounds::kNearestFar);
    }
  }

  const TwoLevel<Real>& two_level_;
  const space::FilterSpace& space_;
  Vec3<double> point_, direction_;
  double size_;
  bool far_;
  NearestResolver<Real>& resolver_;
  kernels::KernelCounts* counts_;
  double limit_;
  kernels::Candidate best_;
  std::vector<Entry> stack_;
};

}  // namespace pierce::scene
