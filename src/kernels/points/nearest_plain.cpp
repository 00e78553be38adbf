// SPDX-License-Identifier: Apache-2.0
//
// The traversal to the nearest triangle without SIMD, in double: the yardstick for the wide one,
// and used for points that are too far away for float. Two measures of what is near: the distance,
// and for points so far away that all distances look alike, how far things reach towards the point.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "bvh/leaf_access.h"
#include "kernels/points/nearest.h"
#include "kernels/points/nearest_best.h"
#include "predicate/bounds.h"
#include "predicate/towards_triangle.h"

namespace pierce::kernels {
namespace {

using Vec = Vec3<double>;
using Bounds = DistanceBounds<double>;

using predicate::max_norm;
using predicate::towards_triangle;

// How near things are to a point. The rounding of copies and of all that is done here is in pads.
class Distance {
 public:
  explicit Distance(const Vec& point) : point_(point), size_(max_norm(point)) {}
  /// At most the distance to anything in the box.
  [[nodiscard]] double to_box(const bvh::Node& node, int child) const {
    const auto outside = [&](double p, int axis) {
      return std::max({static_cast<double>(node.lower[axis][child]) - p,
                       p - static_cast<double>(node.upper[axis][child]), 0.0});
    };
    const Vec d{outside(point_.x, 0), outside(point_.y, 1), outside(point_.z, 2)};
    return std::sqrt(dot(d, d)) - bounds::kNearestPlainReach * (1 + size_);
  }
  /// `reach`: of its leaf.
  [[nodiscard]] Bounds to_triangle(const Vec& p, const Vec& q, const Vec& r, double reach) const {
    const double pad = bounds::kNearestPlainCopy * reach + bounds::kNearestPlainReach * (1 + size_);
    const Vec a = p - point_;
    const Vec b = q - point_;
    const Vec c = r - point_;
    const Vec g = towards_triangle(a, b, c);
    const double high = std::sqrt(dot(g, g));
    const double low = std::min({dot(g, a), dot(g, b), dot(g, c)}) / high;
    return {high > pad ? low - pad : 0.0, high + pad};
  }

 private:
  Vec point_;
  double size_;
};

// The same for a point far away, seen in a direction of max-norm 1: |P - x|^2 is |P|^2 - 2 P . x +
// |x|^2, so distances are ordered by -P . x / |P| + |x|^2 / (2 |P|), of which the second term is
// next to nothing and the first is least at a corner.
class Reach {
 public:
  explicit Reach(const Vec& direction) : direction_(direction) {}
  [[nodiscard]] double to_box(const bvh::Node& node, int child) const {
    const auto least = [&](double d, int axis) {
      return -d * static_cast<double>(d > 0 ? node.upper[axis][child] : node.lower[axis][child]);
    };
    return least(direction_.x, 0) + least(direction_.y, 1) + least(direction_.z, 2) -
           bounds::kNearestFar;
  }
  [[nodiscard]] Bounds to_triangle(const Vec& a, const Vec& b, const Vec& c, double) const {
    const double least = -std::max({dot(direction_, a), dot(direction_, b), dot(direction_, c)});
    return {least - bounds::kNearestFar, least + bounds::kNearestFar};
  }

 private:
  Vec direction_;
};

template <class Measure>
class Traversal {
 public:
  Traversal(const bvh::Tree& tree, const Measure& measure, double limit, NearestResolver& resolver,
            KernelCounts* counts)
      : tree_(tree), measure_(measure), resolver_(resolver), counts_(counts) {
    best_.limit = limit;
  }

  Candidate run() {
    if (tree_.root == bvh::kNoChild) return {};
    NearEntry<double> stack[8 * bvh::kMaxDepth];
    NearEntry<double>* top = stack;
    *top++ = {-std::numeric_limits<double>::infinity(), tree_.root};
    while (top != stack) {
      const NearEntry<double> entry = *--top;
      if (entry.distance > best_.limit) continue;
      if (bvh::is_leaf(entry.ref)) {
        visit_leaf(entry.ref);
        continue;
      }
      if (counts_ != nullptr) ++counts_->nodes;
      const bvh::Node& node = tree_.nodes[entry.ref];
      NearEntry<double>* const first = top;
      for (int child = 0; child < bvh::kWidth && node.child[child] != bvh::kNoChild; ++child) {
        const double distance = measure_.to_box(node, child);
        if (distance > best_.limit) continue;
        push_nearest_on_top({distance, node.child[child]}, first, top);
      }
    }
    return best_.triangle;
  }

 private:
  void visit_leaf(std::uint32_t ref) {
    if (counts_ != nullptr) ++counts_->leaves;
    const std::uint32_t count = bvh::leaf_count(ref);
    bvh::LeafScratch scratch;
    const float* block = bvh::leaf_block(tree_, ref, scratch);
    const float* rows = block + bvh::kLeafHead;
    const auto reach = static_cast<double>(block[1]);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto corner = [&](std::uint32_t row) {
        const auto component = [&](std::uint32_t axis) {
          return static_cast<double>(rows[(row + axis) * count + i]);
        };
        return Vec{component(0), component(1), component(2)};
      };
      const Bounds bounds = measure_.to_triangle(corner(0), corner(3), corner(6), reach);
      if (bounds.low > best_.limit) continue;
      if (counts_ != nullptr) ++counts_->candidates;
      const Candidate candidate{bvh::number_in(rows, count, i), count, rows + i};
      best_.offer(candidate, bounds, resolver_);
    }
  }

  const bvh::Tree& tree_;
  Measure measure_;
  NearestResolver& resolver_;
  KernelCounts* counts_;
  NearestSoFar<double> best_;
};

}  // namespace

Candidate nearest_plain(const bvh::Tree& tree, const FilterPoint& point, NearestResolver& resolver,
                        KernelCounts* counts) {
  if (max_norm(point.position) <= bounds::kNearestFarthest) {
    return Traversal(tree, Distance(point.position), point.limit, resolver, counts).run();
  }
  // No limit: it says nothing about how far things reach.
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  return Traversal(tree, Reach(point.direction), kNoLimit, resolver, counts).run();
}

}  // namespace pierce::kernels
