// SPDX-License-Identifier: Apache-2.0
#include "bvh/quantise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace pierce::bvh {
namespace {

constexpr int kSteps = 255;

/// The last step whose plane is not above x, which is not below the origin.
std::uint8_t step_below(float x, float step, float origin) {
  int q = std::clamp(static_cast<int>((x - origin) / step), 0, kSteps);
  while (q > 0 && plane_of(static_cast<std::uint8_t>(q), step, origin) > x) --q;
  return static_cast<std::uint8_t>(q);
}

/// The first step whose plane is not below x, which is not above the last plane.
std::uint8_t step_above(float x, float step, float origin) {
  int q = std::clamp(static_cast<int>((x - origin) / step), 0, kSteps);
  while (q < kSteps && plane_of(static_cast<std::uint8_t>(q), step, origin) < x) ++q;
  return static_cast<std::uint8_t>(q);
}

/// The smallest step, nearly, with which plane 255 is not below `upper`: of 16 significant bits, so
/// that any multiple up to 255 is a float.
float step_for(float lower, float upper) {
  constexpr int kDigits = 16;
  float step =
      round_up_to(std::max((upper - lower) / static_cast<float>(kSteps), kLeastStep), kDigits);
  while (plane_of(kSteps, step, lower) < upper) step = round_up_to(-step_down(-step), kDigits);
  return step;
}

}  // namespace

float plane_of(std::uint8_t q, float step, float origin) {
  return static_cast<float>(q) * step + origin;
}

CompactNode quantise(const Node& node) {
  CompactNode compact{};
  int count = 0;
  while (count < kWidth && node.child[count] != kNoChild) ++count;
  std::copy(node.child, node.child + kWidth, compact.child);
  for (int k = 0; k < 3; ++k) {
    const float lower = *std::min_element(node.lower[k], node.lower[k] + count);
    const float upper = *std::max_element(node.upper[k], node.upper[k] + count);
    const float step = step_for(lower, upper);
    compact.origin[k] = lower;
    compact.step[k] = step;
    for (int i = 0; i < kWidth; ++i) {
      compact.lower[k][i] = i < count ? step_below(node.lower[k][i], step, lower) : kSteps;
      compact.upper[k][i] = i < count ? step_above(node.upper[k][i], step, lower) : 0;
    }
  }
  return compact;
}

void quantise(Tree& tree) {
  tree.compact_nodes = HugeBuffer<CompactNode>(tree.nodes.size());
  tbb::parallel_for(std::size_t{0}, tree.nodes.size(),
                    [&](std::size_t i) { tree.compact_nodes[i] = quantise(tree.nodes[i]); });
  tree.nodes.clear();
}

Box child_box(const CompactNode& node, int lane) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = plane_of(node.lower[k][lane], node.step[k], node.origin[k]);
    box.upper[k] = plane_of(node.upper[k][lane], node.step[k], node.origin[k]);
  }
  return box;
}

Box child_box(const Node& node, int lane) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = node.lower[k][lane];
    box.upper[k] = node.upper[k][lane];
  }
  return box;
}

}  // namespace pierce::bvh
