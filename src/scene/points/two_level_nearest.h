// SPDX-License-Identifier: Apache-2.0
//
// The traversal to the nearest triangle in two levels. The nearest first; what a box leaves open
// the ladder decides.
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
#include "scene/points/nearest_resolver.h"
#include "scene/points/point_distance.h"
#include "scene/two_level.h"

namespace pierce::scene {

template <class Real>
class TwoLevelNearest {
 public:
  TwoLevelNearest(const TwoLevel<Real>& two_level, const space::FilterSpace& space,
                  const kernels::FilterPoint& point, NearestResolver<Real>& resolver,
                  kernels::KernelCounts* counts)
      : two_level_(two_level),
        distance_(space, point),
        resolver_(resolver),
        counts_(counts),
        limit_(distance_.limit()) {}

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

  void visit_node(const Entry& entry) {
    if (counts_ != nullptr) ++counts_->nodes;
    const bvh::Tree& tree =
        entry.placed == nullptr ? two_level_.top() : two_level_.bottom(*entry.placed).tree;
    const bvh::Node& node = tree.nodes[entry.ref];
    const std::size_t first = stack_.size();
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      const double distance = distance_.to(middle_box(node, i), 0x1p-50, entry.placed);
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
      const auto row = [&](std::uint32_t k) { return rows[k * count + i]; };
      const auto low = [&](std::uint32_t k) { return std::min({row(k), row(k + 3), row(k + 6)}); };
      const auto high = [&](std::uint32_t k) { return std::max({row(k), row(k + 3), row(k + 6)}); };
      const float lower[3] = {low(0), low(1), low(2)}, upper[3] = {high(0), high(1), high(2)};
      const double distance =
          distance_.to(middle_box(lower, upper, 1), copied + 0x1p-50, entry.placed);
      if (distance > limit_) continue;
      if (counts_ != nullptr) ++counts_->candidates;
      offer({bvh::number_in(rows, count, i) + entry.placed->first, 0, nullptr});
    }
  }

  void offer(const kernels::Candidate& candidate) {
    if (best_.primitive != kNone && !resolver_.is_nearer(candidate, best_)) return;
    best_ = candidate;
    limit_ = std::min(limit_, distance_.beyond(resolver_.near(best_)));
  }

  const TwoLevel<Real>& two_level_;
  const PointDistance distance_;
  NearestResolver<Real>& resolver_;
  kernels::KernelCounts* counts_;
  double limit_;
  kernels::Candidate best_;
  std::vector<Entry> stack_;
};

}  // namespace pierce::scene
