// SPDX-License-Identifier: Apache-2.0
#include "bvh/collapse.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "bvh/child_order.h"
#include "bvh/leaf_block.h"
#include "bvh/sah_cost.h"
#include "support/parallel.h"

namespace pierce::bvh {
namespace {

/// Subtrees of fewer than 2^this primitives are measured and written by one thread.
constexpr int kSerialClass = 12;

/// How much memory a subtree takes, its own node included.
struct Extent {
  std::uint64_t nodes = 0;
  std::uint64_t units = 0;   // of leaf memory
  std::uint64_t blocks = 0;  // leaves

  Extent& operator+=(const Extent& other) {
    nodes += other.nodes;
    units += other.units;
    blocks += other.blocks;
    return *this;
  }
};

/// The extents of the large subtrees, so that all of them can be written at once.
struct Plan {
  Extent extent;
  std::vector<Plan> children;  // one a child of the wide node; none for a small subtree
};

/// The children of a wide node: binary nodes.
struct Children {
  std::uint32_t node[kWidth];
  int count = 0;
};

struct LeafPrimitives {
  std::uint32_t number[kWidth];
  std::uint32_t count = 0;
};

/// The next free places.
struct Cursor {
  std::uint64_t node, unit;
};

void set_empty(Node& node) {
  for (int i = 0; i < kWidth; ++i) {
    for (int k = 0; k < 3; ++k) {
      node.lower[k][i] = kEmptyPlane;
      node.upper[k][i] = -kEmptyPlane;
    }
    node.child[i] = kNoChild;
  }
}

class Collapse {
 public:
  Collapse(const BinaryTree& binary, const Primitives& primitives, BuildControl& control,
           Tree& tree)
      : binary_(binary), primitives_(primitives), control_(control), tree_(tree) {}

  [[nodiscard]] Plan plan(std::uint32_t b) const {
    control_.poll();
    if (binary_.nodes[b].size_class() < kSerialClass) return {measure(b), {}};
    const Children children = children_of(b);
    Plan plan{own_extent(b), std::vector<Plan>(static_cast<std::size_t>(children.count))};
    parallel::for_each(0, children.count, [&](int i) {
      plan.children[static_cast<std::size_t>(i)] = this->plan(children.node[i]);
    });
    for (const Plan& child : plan.children) plan.extent += child.extent;
    return plan;
  }

  /// Writes a subtree by the plan. Its own node has its place; what is below it goes to the cursor.
  std::uint32_t write(std::uint32_t b, const Plan& plan, std::uint64_t place, Cursor cursor) {
    if (plan.children.empty()) {
      const std::uint32_t ref = write_serial(b, place, cursor);
      control_.advance(std::uint64_t{1} << binary_.nodes[b].size_class());
      return ref;
    }
    const Children children = children_of(b);
    const std::uint32_t ref = write_node(children, place, cursor);
    const Node& node = tree_.nodes[place];
    Cursor begin[kWidth];
    for (int i = 0; i < children.count; ++i) {
      begin[i] = cursor;
      if (is_leaf(children.node[i])) continue;
      const Extent& extent = plan.children[static_cast<std::size_t>(i)].extent;
      cursor.node += extent.nodes - 1;
      cursor.unit += extent.units;
    }
    parallel::for_each(0, children.count, [&](int i) {
      if (is_leaf(children.node[i])) return;
      write(children.node[i], plan.children[static_cast<std::size_t>(i)], node.child[i], begin[i]);
    });
    for (int i = 0; i < children.count; ++i)
      if (!is_leaf(children.node[i])) note_across(tree_.nodes[place], i);
    return ref;
  }

 private:
  [[nodiscard]] bool is_leaf(std::uint32_t b) const { return binary_.nodes[b].is_leaf(); }

  [[nodiscard]] Extent own_extent(std::uint32_t b) const {
    if (!is_leaf(b)) return {1, 0, 0};
    return {0, leaf_units(tree_.layout, primitives_of(b).count), 1};
  }

  [[nodiscard]] Extent measure(std::uint32_t b) const {
    Extent sum = own_extent(b);
    if (is_leaf(b)) return sum;
    const Children children = unordered_children_of(b);
    for (int i = 0; i < children.count; ++i) sum += measure(children.node[i]);
    return sum;
  }

  std::uint32_t write_serial(std::uint32_t b, std::uint64_t place, Cursor& cursor) {
    if (is_leaf(b)) {
      Axes across = 0;
      return write_leaf(b, cursor, across);
    }
    const Children children = children_of(b);
    const std::uint32_t ref = write_node(children, place, cursor);
    for (int i = 0; i < children.count; ++i) {
      if (is_leaf(children.node[i])) continue;
      write_serial(children.node[i], tree_.nodes[place].child[i], cursor);
      note_across(tree_.nodes[place], i);
    }
    return ref;
  }

  /// Writes one node and the leaves under it, and gives places to its inner children.
  std::uint32_t write_node(const Children& children, std::uint64_t place, Cursor& cursor) {
    Node& node = tree_.nodes[place];
    set_empty(node);
    Axes across[kWidth] = {};
    for (int i = 0; i < children.count; ++i) {
      const BinaryNode& child = binary_.nodes[children.node[i]];
      set_child_box(node, i, padded(box_of(child)));
      node.child[i] = child.is_leaf() ? write_leaf(children.node[i], cursor, across[i])
                                      : static_cast<std::uint32_t>(cursor.node++);
    }
    order_children(node);
    for (int i = 0; i < children.count; ++i) set_across(node, i, across[i]);
    return static_cast<std::uint32_t>(place);
  }

  /// Of a child that is a node, whose own children are known.
  void note_across(Node& node, int lane) {
    set_across(node, lane, axes_across(tree_.nodes[node.child[lane]]));
  }

  std::uint32_t write_leaf(std::uint32_t b, Cursor& cursor, Axes& across) {
    const LeafPrimitives leaf = primitives_of(b);
    std::byte* place = tree_.leaves.data() + cursor.unit * kLeafUnit;
    across = write_leaf_block(tree_.layout, place, primitives_, leaf.number, leaf.count);
    const std::uint32_t ref = make_leaf(static_cast<std::uint32_t>(cursor.unit), leaf.count);
    cursor.unit += leaf_units(tree_.layout, leaf.count);
    return ref;
  }

  /// The primitives of a leaf, each once: pieces of one that was cut may have met again.
  [[nodiscard]] LeafPrimitives primitives_of(std::uint32_t b) const {
    LeafPrimitives leaf;
    add_primitives(b, leaf);
    return leaf;
  }
  void add_primitives(std::uint32_t b, LeafPrimitives& leaf) const {
    const BinaryNode& node = binary_.nodes[b];
    if (node.has_children()) {
      add_primitives(node.first, leaf);
      add_primitives(node.first + 1, leaf);
      return;
    }
    for (std::uint32_t i = 0; i < node.leaf_count(); ++i) {
      const std::uint32_t number = binary_.order[node.first + i];
      if (std::find(leaf.number, leaf.number + leaf.count, number) == leaf.number + leaf.count) {
        leaf.number[leaf.count++] = number;
      }
    }
  }

  /// In the order in which the wide node has them.
  [[nodiscard]] Children children_of(std::uint32_t b) const {
    const Children children = unordered_children_of(b);
    Children ordered;
    float values[kWidth];
    for (int i = 0; i < children.count; ++i) {
      const float value = any_hit_value(children.node[i]);
      int place = i;  // insertion: equal ones stay in their order
      for (; place > 0 && value < values[place - 1]; --place) {
        values[place] = values[place - 1];
        ordered.node[place] = ordered.node[place - 1];
      }
      values[place] = value;
      ordered.node[place] = children.node[i];
    }
    ordered.count = children.count;
    return ordered;
  }
  [[nodiscard]] Children unordered_children_of(std::uint32_t b) const {
    Children children;
    divide(b, kWidth, children);
    return children;
  }
  /// Any-hit order: surface area for each triangle; the last child is visited first.
  [[nodiscard]] float any_hit_value(std::uint32_t b) const {
    const BinaryNode& node = binary_.nodes[b];
    const float x = node.upper[0] - node.lower[0];
    const float y = node.upper[1] - node.lower[1];
    const float z = node.upper[2] - node.lower[2];
    return (x * y + y * z + z * x) / static_cast<float>(1U << node.size_class());
  }
  void divide(std::uint32_t b, int i, Children& out) const {
    const BinaryNode& node = binary_.nodes[b];
    const int share = static_cast<int>(node.left_share(i));
    gather(node.first, share, out);
    gather(node.first + 1, i - share, out);
  }
  void gather(std::uint32_t b, int i, Children& out) const {
    const BinaryNode& node = binary_.nodes[b];
    if (node.has_children()) {
      while (i > 1 && node.left_share(i) == 0) --i;
      if (i > 1) return divide(b, i, out);
    }
    out.node[out.count++] = b;
  }

  const BinaryTree& binary_;
  const Primitives& primitives_;
  BuildControl& control_;
  Tree& tree_;
};

}  // namespace

std::size_t max_leaf_bytes(std::uint32_t n) {
  return std::size_t{n} * leaf_units(Layout::Full, 1) * kLeafUnit + kLeafSlack;
}

void collapse(const BinaryTree& binary, const Primitives& primitives, BuildControl& control,
              Tree& tree) {
  Collapse collapse(binary, primitives, control, tree);
  const Plan plan = collapse.plan(0);
  const Extent& extent = plan.extent;
  if (extent.units > leaf_offset(~0U)) {
    throw Error(ErrorCode::TooManyTriangles,
                "the leaves of the search tree need more than 8 GiB; split the scene");
  }
  tree.nodes = HugeBuffer<Node>(extent.nodes);
  const std::size_t leaf_bytes = extent.units * kLeafUnit;
  tree.leaves.truncate(leaf_bytes + kLeafSlack);
  std::memset(tree.leaves.data() + leaf_bytes, 0, kLeafSlack);
  tree.root = collapse.write(0, plan, 0, {1, 0});

  const Box all = padded(box_of(binary.nodes[0]));
  for (int k = 0; k < 3; ++k) {
    tree.lower[k] = all.lower[k];
    tree.upper[k] = all.upper[k];
  }
  tree.leaf_blocks = extent.blocks;
  tree.sah_cost = sah_cost(tree);
}

}  // namespace pierce::bvh
