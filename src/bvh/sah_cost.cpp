// SPDX-License-Identifier: Apache-2.0
#include "bvh/sah_cost.h"

#include <cstddef>
#include <functional>

#include "bvh/box.h"
#include "support/parallel.h"

namespace pierce::bvh {
namespace {

double half_area(const float* lower, const float* upper) {
  double size[3];
  for (int k = 0; k < 3; ++k) {
    size[k] = static_cast<double>(upper[k]) - static_cast<double>(lower[k]);
  }
  return size[0] * (size[1] + size[2]) + size[1] * size[2];
}

/// The sum of cost times area over all children.
double sum_of(const HugeBuffer<Node>& nodes) {
  return parallel::reduce(
      std::size_t{0}, nodes.size(), 4096, 0.0,
      [&](std::size_t first, std::size_t last) {
        double sum = 0;
        for (std::size_t i = first; i != last; ++i) {
          for (int lane = 0; lane < kWidth && nodes[i].child[lane] != kNoChild; ++lane) {
            const Box box = child_box(nodes[i], lane);
            const float lower[3] = {box.lower[0], box.lower[1], box.lower[2]};
            const float upper[3] = {box.upper[0], box.upper[1], box.upper[2]};
            const float cost = is_leaf(nodes[i].child[lane]) ? kLeafCost : kNodeCost;
            sum += half_area(lower, upper) * static_cast<double>(cost);
          }
        }
        return sum;
      },
      std::plus<double>());
}

}  // namespace

double sah_cost(const Tree& tree) {
  if (tree.root == kNoChild) return 0;
  const auto node_cost = static_cast<double>(kNodeCost), leaf_cost = static_cast<double>(kLeafCost);
  if (is_leaf(tree.root)) return leaf_cost;
  const double root_area = half_area(tree.lower, tree.upper);
  if (!(root_area > 0)) {
    return node_cost * static_cast<double>(tree.nodes.size()) +
           leaf_cost * static_cast<double>(tree.leaf_blocks);
  }
  return node_cost + sum_of(tree.nodes) / root_area;
}

}  // namespace pierce::bvh
