// SPDX-License-Identifier: Apache-2.0
//
// The tree between the builder and the collapse: two children a node, and in every node the
// choices by which the collapse will gather binary nodes into wide ones (forests.h).
#pragma once

#include <bit>
#include <cstdint>

#include "bvh/box.h"
#include "bvh/tree.h"
#include "support/huge_buffer.h"

namespace pierce::bvh {

/// A deeper node is split by count, which ends after at most 32 more levels.
inline constexpr int kSahDepth = kMaxDepth - 32;

struct BinaryNode {
  float lower[3], upper[3];
  std::uint32_t first;   // an inner node: the left child, the right one next; else place in order
  std::uint32_t choice;  // see below

  // choice: bits 0..20 how forests of 2..8 subtrees divide, 3 bits each: how many of the i subtrees
  // go to the left child, or 0: the forest of i - 1 is as good; bits 21..24 number of
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
inline void make_binary_leaf(BinaryNode& node, const Box& box, std::uint32_t first,
                             std::uint32_t count) {
  set_box(node, box);
  node.first = first;
  node.choice =
      BinaryNode::kNoChildren | BinaryNode::leaf_bits(count) | BinaryNode::size_bits(count);
}

/// Makes `node` the parent of two, with `count` primitives below.
inline void make_binary_parent(BinaryNode& node, const Box& box, std::uint32_t left,
                               std::uint32_t count) {
  set_box(node, box);
  node.first = left;
  node.choice = BinaryNode::size_bits(count);
}

}  // namespace pierce::bvh
