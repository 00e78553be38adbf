// SPDX-License-Identifier: Apache-2.0
//
// The same tree around moved corners: first all leaves at once, then the nodes from the last to
// the first, which meets every child before its parent.
#include <algorithm>
#include <cstddef>
#include <iterator>

#include "bvh/box.h"
#include "bvh/child_order.h"
#include "bvh/leaf_block.h"
#include "bvh/sah_cost.h"
#include "bvh/tree.h"
#include "support/build_control.h"
#include "support/parallel.h"

namespace pierce::bvh {
namespace {

/// The box of all children (unused lanes are empty boxes).
Box box_of(const Node& node) {
  Box box;
  for (int lane = 0; lane < kWidth; ++lane) box.grow(child_box(node, lane));
  return box;
}

/// Fills the axes across which it stands.
Box refit_leaf(Tree& tree, std::uint32_t ref, const Primitives& primitives, Axes& across) {
  const std::uint32_t n = leaf_count(ref);
  std::byte* place = tree.leaves.data() + std::size_t{leaf_offset(ref)} * kLeafUnit;
  std::uint32_t numbers[kWidth];
  read_leaf_numbers(tree.layout, place, n, numbers);
  across = write_leaf_block(tree.layout, place, primitives, numbers, n);
  Box box;
  for (std::uint32_t i = 0; i < n; ++i) box.grow(bvh::box_of(primitives.corners(numbers[i])));
  return padded(box);
}

/// Orders the children, which stand where they stand.
void order_again(Node& node) {
  Axes across[kWidth];
  for (int lane = 0; lane < kWidth; ++lane) across[lane] = axes_across(node, lane);
  order_children(node);
  for (int lane = 0; lane < kWidth; ++lane) set_across(node, lane, across[lane]);
}

Box refit_nodes(Tree& tree, const Primitives& primitives, BuildControl& control) {
  const auto refit_leaves = [&](std::size_t first, std::size_t last) {
    control.advance(last - first);
    for (std::size_t i = first; i != last; ++i) {
      Node& node = tree.nodes[i];
      for (int lane = 0; lane < kWidth; ++lane) {
        const std::uint32_t ref = node.child[lane];
        if (!is_leaf(ref)) continue;
        Axes across = 0;
        set_child_box(node, lane, refit_leaf(tree, ref, primitives, across));
        set_across(node, lane, across);
      }
    }
  };
  parallel::for_ranges(std::size_t{0}, tree.nodes.size(), 256, refit_leaves);
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    if (i % 4096 == 0) control.poll();
    Node& node = tree.nodes[i];
    for (int lane = 0; lane < kWidth; ++lane) {
      const std::uint32_t ref = node.child[lane];
      if (is_leaf(ref) || ref == kNoChild) continue;
      set_child_box(node, lane, box_of(tree.nodes[ref]));
      set_across(node, lane, axes_across(tree.nodes[ref]));
    }
  }
  parallel::for_ranges(std::size_t{0}, tree.nodes.size(), 256,
                       [&](std::size_t first, std::size_t last) {
                         for (std::size_t i = first; i != last; ++i) order_again(tree.nodes[i]);
                       });
  return box_of(tree.nodes[tree.root]);
}

}  // namespace

Tree Tree::copy(const WorkOptions& work) const {
  const BuildControl control(work);
  const auto poll = [&control] { control.poll(); };
  Tree copied;
  copied.layout = layout;
  copied.nodes = nodes.copy(poll);
  copied.leaves = leaves.copy(poll);
  copied.primitives = primitives;
  copied.root = root;
  std::copy(std::begin(lower), std::end(lower), copied.lower);
  std::copy(std::begin(upper), std::end(upper), copied.upper);
  copied.leaf_blocks = leaf_blocks;
  copied.sah_cost = sah_cost;
  return copied;
}

void refit(Tree& tree, const Primitives& primitives, const WorkOptions& work) {
  BuildControl control(work);
  if (tree.root == kNoChild) {
    control.report(1);
    return;
  }
  control.phase(0, 1, tree.nodes.size());
  parallel::with_threads(work.threads, [&] {
    if (tree.layout == Layout::Compact) tree.primitives = &primitives;
    Axes across = 0;
    const Box box = is_leaf(tree.root) ? refit_leaf(tree, tree.root, primitives, across)
                                       : refit_nodes(tree, primitives, control);
    for (int k = 0; k < 3; ++k) {
      tree.lower[k] = box.lower[k];
      tree.upper[k] = box.upper[k];
    }
    tree.sah_cost = sah_cost(tree);
  });
  control.report(1);
}

}  // namespace pierce::bvh
