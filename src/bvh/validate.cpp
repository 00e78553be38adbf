// SPDX-License-Identifier: Apache-2.0
//
// The structure of a tree, checked from the outside: nothing here trusts the builder.
#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <vector>

#include "bvh/leaf_block.h"
#include "bvh/tree.h"

namespace pierce::bvh {
namespace {

struct Bounds {
  float lower[3], upper[3];

  [[nodiscard]] bool holds(const Vec3<double>& p) const {
    return holds(0, p.x) && holds(1, p.y) && holds(2, p.z);
  }
  [[nodiscard]] bool holds(int k, double x) const {
    return static_cast<double>(lower[k]) <= x && x <= static_cast<double>(upper[k]);
  }
};

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
    Bounds all;
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
  [[noreturn]] static void fail(const std::string& what) {
    throw std::logic_error("search tree: " + what);
  }
  static void require(bool ok, const char* what) {
    if (!ok) fail(what);
  }

  void visit(std::uint32_t ref, const Bounds& bounds, int depth) {
    require(depth <= kMaxDepth, "deeper than kMaxDepth");
    if (is_leaf(ref)) return visit_leaf(ref, bounds);
    require(ref < tree_.nodes.size(), "reference to a node that does not exist");
    ++nodes_;
    const Node& node = tree_.nodes[ref];
    bool ended = false;
    for (int i = 0; i < kWidth; ++i) {
      Bounds child;
      for (int k = 0; k < 3; ++k) {
        child.lower[k] = node.lower[k][i];
        child.upper[k] = node.upper[k][i];
      }
      if (node.child[i] == kNoChild) {
        require(i >= 2, "a node with fewer than two children");
        for (int k = 0; k < 3; ++k) {
          require(child.lower[k] == kEmptyPlane && child.upper[k] == -kEmptyPlane,
                  "an unused lane has a box");
        }
        ended = true;
        continue;
      }
      require(!ended, "children are not contiguous from lane 0");
      require(is_leaf(node.child[i]) || node.child[i] > ref, "a child comes before its parent");
      for (int k = 0; k < 3; ++k) {
        require(bounds.lower[k] <= child.lower[k] && child.upper[k] <= bounds.upper[k],
                "a child's box leaves its parent's");
      }
      visit(node.child[i], child, depth + 1);
    }
  }

  void visit_leaf(std::uint32_t ref, const Bounds& bounds) {
    ++leaves_;
    const std::uint32_t n = leaf_count(ref);
    const std::size_t offset = std::size_t{leaf_place(ref)} * kLeafUnit;
    require(offset + std::size_t{leaf_units(n)} * kLeafUnit + kLeafSlack <= tree_.leaves.size(),
            "a leaf block leaves the leaf memory");
    float block[10 * kWidth + 1];
    std::memcpy(block, tree_.leaves.data() + offset, (10 * n + 1) * sizeof(float));
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto number = std::bit_cast<std::uint32_t>(block[1 + 9 * n + i]);
      require(number < primitives_.size(), "a leaf names a primitive that does not exist");
      boxes_.push_back({number, bounds});
      const Corners t = primitives_.corners(number);
      const double component[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
      for (std::uint32_t k = 0; k < 9; ++k) {
        require(block[1 + k * n + i] == static_cast<float>(component[k]),
                "a leaf's corner is not the primitive's, rounded");
      }
      require(static_cast<double>(block[0]) >= largest_edge(t), "an edge is larger than E");
    }
  }

  /// Every primitive lies in its leaf's box, or, if it was cut, in the boxes of its leaves: that is
  /// tried at points all over it.
  void check_boxes() {
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
          if (std::none_of(begin, next, [&](const LeafBox& b) { return b.bounds.holds(p); })) {
            fail("primitive " + std::to_string(i) + " leaves the boxes of its leaves");
          }
        }
      }
    }
  }

  /// ((steps - u - v) a + u b + v c) / steps, within 3 * 2^-53, which is less than the slack that
  /// a cut triangle's boxes have; exact at the corners.
  static Vec3<double> point_of(const Corners& t, int u, int v, int steps) {
    const int w = steps - u - v;
    const auto mix = [&](double a, double b, double c) { return (w * a + u * b + v * c) / steps; };
    return {mix(t.a.x, t.b.x, t.c.x), mix(t.a.y, t.b.y, t.c.y), mix(t.a.z, t.b.z, t.c.z)};
  }

  static constexpr int kSteps = 64;  // a power of two: exact division

  struct LeafBox {
    std::uint32_t primitive;
    Bounds bounds;
  };

  const Tree& tree_;
  const Primitives& primitives_;
  std::vector<LeafBox> boxes_;
  std::size_t nodes_ = 0, leaves_ = 0;
};

}  // namespace

void validate_tree(const Tree& tree, const Primitives& primitives) {
  Validator(tree, primitives).run();
}

}  // namespace pierce::bvh
