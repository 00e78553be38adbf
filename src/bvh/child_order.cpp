// SPDX-License-Identifier: Apache-2.0
#include "bvh/child_order.h"

namespace pierce::bvh {
namespace {

constexpr std::uint32_t kHalf = kOctants / 2;  // the others are these, turned round

// On axis k: 1 if box i lies wholly below box j, -1 if above, else 0.
int side(const Node& node, int k, int i, int j) {
  const int below = node.upper[k][i] <= node.lower[k][j] ? 1 : 0;
  const int above = node.lower[k][i] >= node.upper[k][j] ? 1 : 0;
  return below - above;
}

// By how many axes rays of an octant meet first what lies below on these sides, less by how many
// they meet it last.
int first_by(const int (&sides)[3], std::uint32_t octant) {
  int sum = 0;
  for (std::uint32_t k = 0; k < 3; ++k) sum += ((octant >> k) & 1U) != 0 ? -sides[k] : sides[k];
  return sum;
}

// What the children of a node are to the rays of an octant.
struct Ranking {
  float distance[kWidth];       // of their centres along the octant's diagonal
  int met_before[kWidth] = {};  // how many others are

  Ranking(const Node& node, std::uint32_t octant) {
    for (int lane = 0; lane < kWidth; ++lane) {
      const auto centre = [&](int k) { return node.lower[k][lane] + node.upper[k][lane]; };
      distance[lane] = ((octant & 1U) != 0 ? -centre(0) : centre(0)) +
                       ((octant & 2U) != 0 ? -centre(1) : centre(1)) + centre(2);
    }
  }

  [[nodiscard]] bool is_farther(int i, int j) const {
    if (met_before[i] != met_before[j]) return met_before[i] > met_before[j];
    return distance[i] != distance[j] ? distance[i] > distance[j] : i < j;
  }
  // A lane's place, the farthest first.
  [[nodiscard]] int place_of(int lane) const {
    int place = 0;
    for (int other = 0; other < kWidth; ++other)
      place += other != lane && is_farther(other, lane) ? 1 : 0;
    return place;
  }
};

}  // namespace

void order_children(Node& node) {
  Ranking rankings[kHalf] = {{node, 0}, {node, 1}, {node, 2}, {node, 3}};
  for (int i = 0; i < kWidth; ++i) {
    for (int j = i + 1; j < kWidth; ++j) {
      const int sides[3] = {side(node, 0, i, j), side(node, 1, i, j), side(node, 2, i, j)};
      for (std::uint32_t octant = 0; octant < kHalf; ++octant) {
        Ranking& ranking = rankings[octant];
        const int first = first_by(sides, octant);
        const bool i_first = first != 0 ? first > 0 : ranking.distance[i] < ranking.distance[j];
        ++ranking.met_before[i_first ? j : i];
      }
    }
  }
  for (std::uint32_t octant = 0; octant < kHalf; ++octant) {
    std::uint32_t order = 0, opposite = 0;
    for (int lane = 0; lane < kWidth; ++lane) {
      const int place = rankings[octant].place_of(lane);
      order |= static_cast<std::uint32_t>(lane) << (kOrderBits * place);
      opposite |= static_cast<std::uint32_t>(lane) << (kOrderBits * (kWidth - 1 - place));
    }
    node.order[octant] = order;
    node.order[kOctants - 1 - octant] = opposite;
  }
}

}  // namespace pierce::bvh
