// SPDX-License-Identifier: Apache-2.0
#include "io/corner_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace pierce::io {

void CornerTree::build(const std::vector<ShadowPoint>& points) {
  nodes_.assign(2 * std::bit_ceil(points.size()), Node{});
  leaves_.resize(points.size());
  corners_.resize(points.size());
  std::iota(corners_.begin(), corners_.end(), 0);
  fill(1, points, 0, points.size());
}

void CornerTree::remove(std::uint32_t corner) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::uint32_t number = leaves_[corner];
  nodes_[number].lower.fill(kInfinity);
  nodes_[number].upper.fill(-kInfinity);
  while (number > 1) unite(number /= 2);
}

void CornerTree::fill(std::uint32_t number, const std::vector<ShadowPoint>& points,
                      std::size_t begin, std::size_t end) {
  Node& node = nodes_[number];
  if (end - begin == 1) {
    const ShadowPoint& p = points[corners_[begin]];
    node = {{p.x, p.y}, {p.x, p.y}, corners_[begin]};
    leaves_[corners_[begin]] = number;
    return;
  }
  const auto first = corners_.begin() + static_cast<std::ptrdiff_t>(begin),
             last = corners_.begin() + static_cast<std::ptrdiff_t>(end),
             middle = first + (last - first) / 2;
  const auto by_x = [&](std::uint32_t i, std::uint32_t j) { return points[i].x < points[j].x; };
  const auto by_y = [&](std::uint32_t i, std::uint32_t j) { return points[i].y < points[j].y; };
  const auto [left, right] = std::minmax_element(first, last, by_x);
  const auto [low, high] = std::minmax_element(first, last, by_y);
  // Halves, so that what is wide is no infinity.
  if (points[*right].x / 2 - points[*left].x / 2 > points[*high].y / 2 - points[*low].y / 2) {
    std::nth_element(first, middle, last, by_x);
  } else {
    std::nth_element(first, middle, last, by_y);
  }
  const auto half = static_cast<std::size_t>(middle - corners_.begin());
  fill(2 * number, points, begin, half);
  fill(2 * number + 1, points, half, end);
  unite(number);
}

// The box around those of both children.
void CornerTree::unite(std::uint32_t number) {
  const Node &left = nodes_[2 * number], &right = nodes_[2 * number + 1];
  Node& node = nodes_[number];
  for (std::size_t k = 0; k < 2; ++k) {
    node.lower[k] = std::min(left.lower[k], right.lower[k]);
    node.upper[k] = std::max(left.upper[k], right.upper[k]);
  }
}

}  // namespace pierce::io
