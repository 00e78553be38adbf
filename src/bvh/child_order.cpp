// SPDX-License-Identifier: Apache-2.0
#include "bvh/child_order.h"

namespace pierce::bvh {
namespace {

// A lane's place among the children, the farthest first. Of two that are as far, the first lane.
int place_of(int lane, const float (&distance)[kWidth]) {
  int place = 0;
  for (int other = 0; other < kWidth; ++other) {
    const bool farther = distance[other] > distance[lane];
    const bool before = distance[other] == distance[lane] && other < lane;
    place += farther || before ? 1 : 0;
  }
  return place;
}

}  // namespace

void order_children(Node& node) {
  for (std::uint32_t octant = 0; octant < kOctants / 2; ++octant) {
    float distance[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) {
      const auto centre = [&](int axis) { return node.lower[axis][lane] + node.upper[axis][lane]; };
      distance[lane] = ((octant & 1U) != 0 ? -centre(0) : centre(0)) +
                       ((octant & 2U) != 0 ? -centre(1) : centre(1)) + centre(2);
    }
    std::uint32_t order = 0, opposite = 0;
    for (int lane = 0; lane < kWidth; ++lane) {
      const int place = place_of(lane, distance);
      order |= static_cast<std::uint32_t>(lane) << (kOrderBits * place);
      opposite |= static_cast<std::uint32_t>(lane) << (kOrderBits * (kWidth - 1 - place));
    }
    node.order[octant] = order;
    node.order[kOctants - 1 - octant] = opposite;
  }
}

}  // namespace pierce::bvh
