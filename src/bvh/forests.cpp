// SPDX-License-Identifier: Apache-2.0
#include "bvh/forests.h"

#include <algorithm>

#include "bvh/sah_cost.h"
#include "support/parallel.h"

namespace pierce::bvh {
namespace {

/// Of subtrees of fewer than 2^this primitives one thread makes all choices.
constexpr int kChosenAloneClass = 12;

/// What a parent must know of its child: box, and costs of the forests of 1 to 7 subtrees.
struct Forest {
  Box box;
  float cost[kWidth - 1] = {};
  std::uint32_t count = 0;  // primitives below
};

Forest forest_of_leaf(const BinaryNode& node) {
  Forest forest{box_of(node), {}, node.leaf_count()};
  std::fill_n(forest.cost, kWidth - 1, kLeafCost * half_area(forest.box));
  return forest;
}

/// Decides how the parent's own forests divide.
Forest join_forests(BinaryNode& node, const Forest& left, const Forest& right,
                    std::uint32_t largest_leaf) {
  Forest forest{box_of(node), {}, left.count + right.count};
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

Forest choose(BinaryTree& tree, std::uint32_t n, std::uint32_t largest_leaf,
              BuildControl& control) {
  BinaryNode& node = tree.nodes[n];
  if (!node.has_children()) return forest_of_leaf(node);
  Forest left, right;
  const auto choose_left = [&] { left = choose(tree, node.first, largest_leaf, control); };
  const auto choose_right = [&] { right = choose(tree, node.first + 1, largest_leaf, control); };
  if (node.size_class() < kChosenAloneClass) {
    choose_left();
    choose_right();
  } else {
    control.poll();
    parallel::invoke(choose_left, choose_right);
  }
  return join_forests(node, left, right, largest_leaf);
}

}  // namespace

void choose_forests(BinaryTree& tree, std::uint32_t largest_leaf, BuildControl& control) {
  choose(tree, 0, largest_leaf, control);
}

}  // namespace pierce::bvh
