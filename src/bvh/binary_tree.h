// SPDX-License-Identifier: Apache-2.0
//
// The tree between the builder and the collapse: two children a node, and in every node the
// decisions by which the collapse will gather binary nodes into wide ones.
//
// Decisions (Ylitie, Karras, Laine 2017, section 3): "the cheapest forest of at most i wide
// subtrees that covers this node", for i = 1..8, by dynamic programming from the leaves up. The
// costs themselves live only while the tree is built; a node keeps the choices, three bits each:
// how many of the i subtrees go to the left child, or 0: the forest of i - 1 is as good.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "bvh/box.h"
#include "bvh/sah_cost.h"
#include "bvh/tree.h"
#include "support/huge_buffer.h"

namespace pierce::bvh {

/// A deeper node is split by count, which ends after at most 32 more levels.
inline constexpr int kSahDepth = kMaxDepth - 32;

/// What a parent must know of its child: box, and costs of the forests of 1 to 7 subtrees.
struct Forest {
  Box box;
  float cost[kWidth - 1] = {};
  std::uint32_t count = 0;  // primitives below
};

struct BinaryNode {
  float lower[3], upper[3];
  std::uint32_t first;   // an inner node: the left child, the right one next; else place in order
  std::uint32_t choice;  // see below

  // choice: bits 0..20 how forests of 2..8 subtrees divide, 3 bits each; bits 21..24 number of
  // primitives if this becomes a leaf, else 0; bits 25..29 the size class; bit 31: no children
  static constexpr std::uint32_t kNoChildren = 0x80000000U;

  [[nodiscard]] bool has_children() const { return (choice & kNoChildren) == 0; }
  [[nodiscard]] bool is_leaf() const { return leaf_count() != 0; }
  [[nodiscard]] std::uint32_t leaf_count() const { return (choice >> 21) & 15U; }
  /// At least 2^size_class() primitives below, and fewer than twice as many.
  [[nodiscard]] int size_class() const { return static_cast<int>((choice >> 25) & 31U); }
  /// Of i (2..8) subtrees, how many go left; 0: i - 1 subtrees are as good.
  [[nodiscard]] std::uint32_t left_share(int i) const { return (choice >> (3 * (i - 2))) & 7U; }

  static std::uint32_t leaf_bits(std::uint32_t count) { return count << 21; }
  static std::uint32_t size_bits(std::uint32_t count) {
    return static_cast<std::uint32_t>(std::bit_width(count) - 1) << 25;
  }
};
static_assert(sizeof(BinaryNode) == 32);

struct BinaryTree {
  HugeBuffer<BinaryNode> nodes;     // the root is node 0; children are neighbours
  HugeBuffer<std::uint32_t> order;  // the primitives; every subtree owns a run of them
};

inline void set_box(BinaryNode& node, const Box& box) {
  for (int k = 0; k < 3; ++k) {
    node.lower[k] = box.lower[k];
    node.upper[k] = box.upper[k];
  }
}

inline Box box_of(const BinaryNode& node) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = node.lower[k];
    box.upper[k] = node.upper[k];
  }
  return box;
}

/// Makes `node` a leaf of 1 to 8 primitives from `first` on in the order.
inline Forest make_binary_leaf(BinaryNode& node, const Box& box, std::uint32_t first,
                               std::uint32_t count) {
  set_box(node, box);
  node.first = first;
  node.choice =
      BinaryNode::kNoChildren | BinaryNode::leaf_bits(count) | BinaryNode::size_bits(count);
  Forest forest{box, {}, count};
  std::fill_n(forest.cost, kWidth - 1, kLeafCost * half_area(box));
  return forest;
}

/// Makes `node` the parent of two forests and decides how its own forests divide. Leaves hold up to
/// `largest_leaf` primitives.
inline Forest join_forests(BinaryNode& node, std::uint32_t left_index, const Forest& left,
                           const Forest& right, std::uint32_t largest_leaf) {
  Forest forest{merged(left.box, right.box), {}, left.count + right.count};
  set_box(node, forest.box);
  node.first = left_index;

  std::uint32_t choice = 0;
  float divided[kWidth + 1];  // cheapest way to give i subtrees to both children
  for (int i = 2; i <= kWidth; ++i) {
    float best = left.cost[0] + right.cost[i - 2];
    std::uint32_t share = 1;
    for (int k = 2; k < i; ++k) {
      const float cost = left.cost[k - 1] + right.cost[i - k - 1];
      if (cost < best) {
        best = cost;
        share = static_cast<std::uint32_t>(k);
      }
    }
    divided[i] = best;
    choice |= share << (3 * (i - 2));
  }

  const float area = half_area(forest.box);
  forest.cost[0] = kNodeCost * area + divided[kWidth];
  if (forest.count <= largest_leaf && kLeafCost * area <= forest.cost[0]) {
    forest.cost[0] = kLeafCost * area;
    choice |= BinaryNode::leaf_bits(forest.count);
  }
  for (int i = 2; i < kWidth; ++i) {
    forest.cost[i - 1] = divided[i];
    if (forest.cost[i - 2] <= divided[i]) {
      forest.cost[i - 1] = forest.cost[i - 2];
      choice &= ~(7U << (3 * (i - 2)));
    }
  }
  node.choice = choice | BinaryNode::size_bits(forest.count);
  return forest;
}

}  // namespace pierce::bvh
