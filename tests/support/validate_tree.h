// SPDX-License-Identifier: Apache-2.0
//
// The structure of a tree, checked from the outside: nothing here trusts the builder.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "bvh/box.h"
#include "bvh/leaf_access.h"
#include "bvh/leaf_block.h"
#include "bvh/tree.h"
#include "predicate/types.h"

namespace pierce::bvh {
namespace validate {

[[noreturn]] inline void fail(const std::string& what) {
  throw std::logic_error("search tree: " + what);
}

inline void require(bool ok, const char* what) {
  if (!ok) fail(what);
}

inline Box common(const Box& a, const Box& b) {
  return Box{max4(a.lower, b.lower), min4(a.upper, b.upper)};
}

inline bool holds(const Box& box, const Vec3<double>& p) {
  const auto between = [&](int k, double x) {
    return static_cast<double>(box.lower[k]) <= x && x <= static_cast<double>(box.upper[k]);
  };
  return between(0, p.x) && between(1, p.y) && between(2, p.z);
}

/// ((steps - u - v) a + u b + v c) / steps, within 3 * 2^-53, which is less than the slack that a
/// cut triangle's boxes have; exact at the corners.
inline Vec3<double> point_of(const Corners& t, int u, int v, int steps) {
  const int w = steps - u - v;
  const auto mix = [&](double a, double b, double c) { return (w * a + u * b + v * c) / steps; };
  return {mix(t.a.x, t.b.x, t.c.x), mix(t.a.y, t.b.y, t.c.y), mix(t.a.z, t.b.z, t.c.z)};
}

inline bool is_unused(const Node& node, int lane) {
  bool empty = true;
  for (int k = 0; k < 3; ++k) {
    empty &= node.lower[k][lane] == kEmptyPlane && node.upper[k][lane] == -kEmptyPlane;
  }
  return empty;
}

class Validator {
 public:
  Validator(const Tree& tree, const Primitives& primitives)
      : tree_(tree), primitives_(primitives) {}

  void run() {
    if (primitives_.size() == 0) {
      require(tree_.root == kNoChild, "a tree over nothing must have no root");
      return;
    }
    require(tree_.leaves.size() >= kLeafSlack, "leaf memory lacks its slack");
    Box all;
    for (int k = 0; k < 3; ++k) {
      all.lower[k] = tree_.lower[k];
      all.upper[k] = tree_.upper[k];
    }
    visit(tree_.root, all, 0);
    require(nodes_ == tree_.nodes.size(), "a node is not reached exactly once");
    require(leaves_ == tree_.leaf_blocks, "leaf_blocks is not the number of leaves");
    check_boxes();
  }

 private:
  /// Each octant's order names each lane once, and the opposite octant's is the same backward.
  static void check_order(const Node& node) {
    for (std::uint32_t octant = 0; octant < kOctants; ++octant) {
      unsigned seen = 0;
      for (int place = 0; place < kWidth; ++place) {
        const auto lane_at = [&](std::uint32_t o, int i) {
          return (node.order[o] >> (kOrderBits * i)) & (kWidth - 1);
        };
        seen |= 1U << lane_at(octant, place);
        require(lane_at(octant, place) == lane_at(kOctants - 1 - octant, kWidth - 1 - place),
                "the orders of opposite octants are not the same backward");
      }
      require(seen == (1U << kWidth) - 1, "an octant's order leaves out a child");
    }
  }

  /// `bounds` is what all boxes on the way have in common, `across` the axes across which all below
  /// should stand.
  void visit(std::uint32_t ref, const Box& bounds, int depth, Axes across = 0) {
    require(depth <= kMaxDepth, "deeper than kMaxDepth");
    if (is_leaf(ref)) return visit_leaf(ref, bounds, across);
    require(ref < tree_.nodes.size(), "reference to a node that does not exist");
    ++nodes_;
    const Node& node = tree_.nodes[ref];
    check_order(node);
    bool ended = false;
    for (int i = 0; i < kWidth; ++i) {
      if (node.child[i] == kNoChild) {
        require(i >= 2, "a node with fewer than two children");
        require(is_unused(node, i), "an unused lane has a box");
        ended = true;
        continue;
      }
      require(!ended, "children are not contiguous from lane 0");
      require(is_leaf(node.child[i]) || node.child[i] > ref, "a child comes before its parent");
      visit(node.child[i], common(bounds, child_box(node, i)), depth + 1,
            across | axes_across(node, i));
    }
  }

  void visit_leaf(std::uint32_t ref, const Box& bounds, Axes across) {
    ++leaves_;
    const std::uint32_t n = leaf_count(ref);
    const std::size_t offset = std::size_t{leaf_offset(ref)} * kLeafUnit;
    const std::size_t size = std::size_t{leaf_units(tree_.layout, n)} * kLeafUnit;
    require(offset + size + kLeafSlack <= tree_.leaves.size(), "a leaf leaves the leaf memory");
    const bvh::LeafNumber* numbers = leaf_numbers(tree_, ref);
    for (std::uint32_t i = 0; i < n; ++i) {
      require(numbers[i] < primitives_.size(), "a leaf names no primitive");
      check_across(numbers[i], across);
    }
    LeafScratch scratch;
    const LeafContents leaf =
        read_leaf_block(reinterpret_cast<const std::byte*>(leaf_block(tree_, ref, scratch)), n);
    for (std::uint32_t i = 0; i < n; ++i) {
      check_copy(leaf, i);
      boxes_.push_back({leaf.primitive[i], bounds});
    }
  }

  void check_across(std::uint32_t primitive, Axes across) const {
    const Corners t = primitives_.corners(primitive);
    const predicate::TriangleD here{t.a, t.b, t.c};
    require((across & ~predicate::axes_across(here)) == 0 &&
                primitives_.across(primitive, across) == across,
            "a triangle does not stand across an axis as its node says");
  }

  void check_copy(const LeafContents& leaf, std::uint32_t i) const {
    const Corners t = primitives_.corners(leaf.primitive[i]);
    const double component[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    for (int k = 0; k < 9; ++k) {
      require(leaf.corner[i][k] == static_cast<float>(component[k]),
              "a leaf's corner is not the primitive's");
    }
    require(static_cast<double>(leaf.edge) >= largest_edge(t),
            "an edge is larger than the leaf says");
  }

  /// Every primitive lies in the boxes of its leaf, or, if it was cut, in those of its leaves: that
  /// is tried at points all over it.
  void check_boxes() {
    constexpr int kSteps = 64;  // a power of two: exact division
    std::sort(boxes_.begin(), boxes_.end(),
              [](const LeafBox& a, const LeafBox& b) { return a.primitive < b.primitive; });
    auto next = boxes_.begin();
    for (std::uint32_t i = 0; i < primitives_.size(); ++i) {
      const auto begin = next;
      while (next != boxes_.end() && next->primitive == i) ++next;
      if (begin == next) fail("primitive " + std::to_string(i) + " is in no leaf");
      const int steps = next - begin == 1 ? 1 : kSteps;
      const Corners t = primitives_.corners(i);
      for (int u = 0; u <= steps; ++u) {
        for (int v = 0; v <= steps - u; ++v) {
          const Vec3<double> p = point_of(t, u, v, steps);
          if (std::none_of(begin, next, [&](const LeafBox& b) { return holds(b.box, p); })) {
            fail("primitive " + std::to_string(i) + " leaves the boxes of its leaves");
          }
        }
      }
    }
  }

  struct LeafBox {
    std::uint32_t primitive;
    Box box;
  };

  const Tree& tree_;
  const Primitives& primitives_;
  std::vector<LeafBox> boxes_;
  std::size_t nodes_ = 0, leaves_ = 0;
};

}  // namespace validate

/// Checks structure: every primitive in at least one leaf, boxes hold what is below them,
/// references in range, unused lanes empty, E an upper bound. Throws std::logic_error that says
/// what is wrong.
inline void validate_tree(const Tree& tree, const Primitives& primitives) {
  validate::Validator(tree, primitives).run();
}

}  // namespace pierce::bvh
