// SPDX-License-Identifier: Apache-2.0
#include "bvh/sah_cost.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>
#include <functional>

namespace pierce::bvh {
namespace {

double half_area(const Node& node, int lane) {
  double size[3];
  for (int k = 0; k < 3; ++k) {
    size[k] = static_cast<double>(node.upper[k][lane]) - static_cast<double>(node.lower[k][lane]);
  }
  return size[0] * (size[1] + size[2]) + size[1] * size[2];
}

}  // namespace

double sah_cost(const Tree& tree) {
  if (tree.root == kNoChild) return 0;
  const auto node_cost = static_cast<double>(kNodeCost), leaf_cost = static_cast<double>(kLeafCost);
  if (is_leaf(tree.root)) return leaf_cost;

  double size[3];
  for (int k = 0; k < 3; ++k) {
    size[k] = static_cast<double>(tree.upper[k]) - static_cast<double>(tree.lower[k]);
  }
  const double root_area = size[0] * (size[1] + size[2]) + size[1] * size[2];
  if (!(root_area > 0)) {
    return node_cost * static_cast<double>(tree.nodes.size()) +
           leaf_cost * static_cast<double>(tree.leaf_blocks);
  }
  // Sums of parts of fixed size: the same for every number of threads.
  using Range = tbb::blocked_range<std::size_t>;
  const double below = tbb::parallel_deterministic_reduce(
      Range(0, tree.nodes.size(), 4096), 0.0,
      [&](const Range& range, double sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const Node& node = tree.nodes[i];
          for (int lane = 0; lane < kWidth && node.child[lane] != kNoChild; ++lane) {
            sum += half_area(node, lane) * (is_leaf(node.child[lane]) ? leaf_cost : node_cost);
          }
        }
        return sum;
      },
      std::plus<double>());
  return node_cost + below / root_area;
}

}  // namespace pierce::bvh
