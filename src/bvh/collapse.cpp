// SPDX-License-Identifier: Apache-2.0
#include "bvh/collapse.h"

#include <cstddef>
#include <vector>

#include "bvh/leaf_block.h"

namespace pierce::bvh {
namespace {

/// How much memory a subtree takes.
struct Extent {
  std::uint64_t nodes = 0;
  std::uint64_t units = 0;   // of leaf memory
  std::uint64_t blocks = 0;  // leaves
  double cost = 0;           // not yet divided by the root's area

  Extent& operator+=(const Extent& o) {
    nodes += o.nodes, units += o.units, blocks += o.blocks, cost += o.cost;
    return *this;
  }
};

double half_area(const BinaryNode& node) {
  double size[3];
  for (int k = 0; k < 3; ++k) {
    size[k] = static_cast<double>(node.upper[k]) - static_cast<double>(node.lower[k]);
  }
  return size[0] * (size[1] + size[2]) + size[1] * size[2];
}

/// The children of a wide node: binary nodes.
struct Children {
  std::uint32_t node[kWidth];
  int count = 0;
};

class Collapse {
 public:
  Collapse(const BinaryTree& binary, const HugeBuffer<PrimitiveRef>& refs,
           const Primitives& primitives, BuildControl& control)
      : binary_(binary.nodes), refs_(refs), primitives_(primitives), control_(control) {}

  [[nodiscard]] bool is_leaf(std::uint32_t b) const { return binary_[b].leaf_count() != 0; }

  [[nodiscard]] Extent measure(std::uint32_t b) const {
    const double area = half_area(binary_[b]);
    if (is_leaf(b)) {
      return {0, leaf_units(binary_[b].leaf_count()), 1, area * static_cast<double>(kLeafCost)};
    }
    Extent sum{1, 0, 0, area * static_cast<double>(kNodeCost)};
    const Children children = children_of(b);
    for (int i = 0; i < children.count; ++i) sum += measure(children.node[i]);
    return sum;
  }

  /// Writes the subtree of `b`, whose node (if it is not a leaf) has its place already; the nodes
  /// and blocks below it go to the next free places. Returns the reference.
  std::uint32_t write(std::uint32_t b, std::uint32_t place, Tree& tree) {
    if (is_leaf(b)) return write_leaf(b, tree);
    const Children children = children_of(b);
    std::uint32_t next = next_node_;
    for (int i = 0; i < children.count; ++i) next_node_ += is_leaf(children.node[i]) ? 0 : 1;
    Node node;
    for (int i = 0; i < kWidth; ++i) {
      set_empty(node, i);
      if (i >= children.count) continue;
      const BinaryNode& child = binary_[children.node[i]];
      for (int k = 0; k < 3; ++k) {
        node.lower[k][i] = child.lower[k];
        node.upper[k][i] = child.upper[k];
      }
      node.child[i] = is_leaf(children.node[i]) ? write_leaf(children.node[i], tree) : next++;
    }
    tree.nodes[place] = node;
    for (int i = 0; i < children.count; ++i) {
      if (!is_leaf(children.node[i])) write(children.node[i], node.child[i], tree);
    }
    return place;
  }

  void begin_at(std::uint32_t node, std::uint32_t unit) {
    next_node_ = node;
    next_unit_ = unit;
  }

 private:
  static void set_empty(Node& node, int lane) {
    for (int k = 0; k < 3; ++k) {
      node.lower[k][lane] = kEmptyPlane;
      node.upper[k][lane] = -kEmptyPlane;
    }
    node.child[lane] = kNoChild;
    node.pad[lane] = 0;
  }

  [[nodiscard]] Children children_of(std::uint32_t b) const {
    Children children;
    divide(b, kWidth, children);
    return children;
  }
  void divide(std::uint32_t b, int i, Children& out) const {
    const BinaryNode& node = binary_[b];
    const int share = static_cast<int>(node.left_share(i));
    gather(node.first, share, out);
    gather(node.first + 1, i - share, out);
  }
  void gather(std::uint32_t b, int i, Children& out) const {
    const BinaryNode& node = binary_[b];
    if (node.has_children()) {
      while (i > 1 && node.left_share(i) == 0) --i;
      if (i > 1) return divide(b, i, out);
    }
    out.node[out.count++] = b;
  }

  std::uint32_t write_leaf(std::uint32_t b, Tree& tree) {
    const std::uint32_t n = binary_[b].leaf_count();
    while (binary_[b].has_children()) b = binary_[b].first;
    std::uint32_t numbers[kWidth];
    for (std::uint32_t i = 0; i < n; ++i) numbers[i] = refs_[binary_[b].first + i].primitive();
    const std::uint32_t unit = next_unit_;
    next_unit_ += leaf_units(n);
    write_leaf_block(tree.leaves.data() + std::size_t{unit} * kLeafUnit, primitives_, numbers, n);
    return make_leaf(unit, n);
  }

  const HugeBuffer<BinaryNode>& binary_;
  const HugeBuffer<PrimitiveRef>& refs_;
  const Primitives& primitives_;
  BuildControl& control_;
  std::uint32_t next_node_ = 0, next_unit_ = 0;
};

}  // namespace

Tree collapse(const BinaryTree& binary, const HugeBuffer<PrimitiveRef>& refs,
              const Primitives& primitives, BuildControl& control) {
  Collapse collapse(binary, refs, primitives, control);
  const Extent extent = collapse.measure(0);
  if (extent.units > leaf_place(~0U)) {
    throw Error(ErrorCode::TooManyTriangles,
                "the leaves of the search tree need more than 8 GiB; split the scene");
  }
  Tree tree;
  tree.nodes = HugeBuffer<Node>(extent.nodes);
  const std::size_t leaf_bytes = extent.units * kLeafUnit;
  tree.leaves = HugeBuffer<std::byte>(leaf_bytes + kLeafSlack);
  std::memset(tree.leaves.data() + leaf_bytes, 0, kLeafSlack);
  collapse.begin_at(collapse.is_leaf(0) ? 0 : 1, 0);
  tree.root = collapse.write(0, 0, tree);
  for (int k = 0; k < 3; ++k) {
    tree.lower[k] = binary.nodes[0].lower[k];
    tree.upper[k] = binary.nodes[0].upper[k];
  }
  tree.leaf_blocks = extent.blocks;
  const double area = half_area(binary.nodes[0]);
  tree.sah_cost = area > 0 ? extent.cost / area : static_cast<double>(extent.nodes + extent.blocks);
  return tree;
}

}  // namespace pierce::bvh
