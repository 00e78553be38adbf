// SPDX-License-Identifier: Apache-2.0
//
// The traversal along an axis without SIMD: every triangle of every leaf whose box the packet may
// enter goes to the resolver, for every point. The yardstick for the wide ones.
#include <algorithm>
#include <bit>
#include <vector>

#include "bvh/leaf_access.h"
#include "kernels/points/axis.h"

namespace pierce::kernels {
namespace {

bool may_enter(const bvh::Node& node, int child, const AxisPacket& packet) {
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const bool open_above = axis == packet.axis && packet.forward;
    const bool open_below = axis == packet.axis && !packet.forward;
    if (!open_above && packet.upper[axis] < node.lower[axis][child]) return false;
    if (!open_below && packet.lower[axis] > node.upper[axis][child]) return false;
  }
  return true;
}

void ask_about_leaf(const bvh::Tree& tree, std::uint32_t ref, AxisPacket& packet,
                    AxisResolver& resolver, MetTriangles& met, KernelCounts* counts) {
  const std::uint32_t count = bvh::leaf_count(ref);
  bvh::LeafScratch scratch;
  const float* rows = bvh::leaf_block(tree, ref, scratch) + bvh::kLeafHead;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Candidate candidate{bvh::number_in(rows, count, i), count, rows + i};
    if (packet.repeats && !met.add(candidate.primitive)) continue;
    if (counts != nullptr) counts->candidates += packet.count;
    for (std::uint32_t point = 0; point < packet.count; ++point) {
      packet.winding[point] += resolver.passage(point, candidate);
    }
  }
}

}  // namespace

void traverse_axis_plain(const bvh::Tree& tree, AxisPacket& packet, AxisResolver& resolver,
                         KernelCounts* counts) {
  std::fill_n(packet.winding, kAxisPoints, 0);
  MetTriangles met;
  std::vector<std::uint32_t> stack;
  if (tree.root != bvh::kNoChild) stack.push_back(tree.root);
  while (!stack.empty()) {
    const std::uint32_t ref = stack.back();
    stack.pop_back();
    if (bvh::is_leaf(ref)) {
      if (counts != nullptr) ++counts->leaves;
      ask_about_leaf(tree, ref, packet, resolver, met, counts);
      continue;
    }
    if (counts != nullptr) ++counts->nodes;
    const bvh::Node& node = tree.nodes[ref];
    for (int child = 0; child < bvh::kWidth && node.child[child] != bvh::kNoChild; ++child) {
      if (may_enter(node, child, packet)) stack.push_back(node.child[child]);
    }
  }
}

}  // namespace pierce::kernels
