// SPDX-License-Identifier: Apache-2.0
//
// CornerTree: which corners of a polygon may lie in a triangle.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pierce::io {

/// Where a corner's shadow lies.
struct ShadowPoint {
  double x, y;
};

/// A binary tree of the boxes of corners, each split at the middle of its wider side.
class CornerTree {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Corners get the numbers 0, 1 and so on. Takes time like n log n.
  void build(const std::vector<ShadowPoint>& points);

  /// The corner is found no more. Takes time like log n.
  void remove(std::uint32_t corner);

  /// The first corner for which `is_wanted(corner)`, or kNone. Asked about are all in the closed
  /// triangle, whose area has this sign, and perhaps some others near it.
  template <class IsWanted>
  [[nodiscard]] std::uint32_t find(const std::array<ShadowPoint, 3>& triangle, int sign,
                                   const IsWanted& is_wanted) const {
    const std::array<Edge, 3> edges = {Edge(triangle[0], triangle[1], sign),
                                       Edge(triangle[1], triangle[2], sign),
                                       Edge(triangle[2], triangle[0], sign)};
    std::array<std::uint32_t, 64> stack;
    std::size_t size = 0;
    stack[size++] = 1;
    while (size > 0) {
      const std::uint32_t number = stack[--size];
      const Node& node = nodes_[number];
      if (node.lower[0] > node.upper[0]) continue;  // none is left
      if (edges[0].parts(node) || edges[1].parts(node) || edges[2].parts(node)) continue;
      if (node.corner == kNone) {
        stack[size++] = 2 * number + 1;
        stack[size++] = 2 * number;
      } else if (is_wanted(node.corner)) {
        return node.corner;
      }
    }
    return kNone;
  }

 private:
  struct Node {
    std::array<double, 2> lower, upper;
    std::uint32_t corner = kNone;  // of a leaf
  };

  // Tells boxes that lie beyond an edge of the triangle, for sure.
  struct Edge {
    ShadowPoint from;
    double along_x, along_y;  // turned so that the triangle is on the left

    Edge(const ShadowPoint& p, const ShadowPoint& q, int sign)
        : from(p), along_x(sign * (q.x - p.x)), along_y(sign * (q.y - p.y)) {}

    [[nodiscard]] bool parts(const Node& node) const {
      const double x = (along_y > 0 ? node.lower[0] : node.upper[0]) - from.x;
      const double y = (along_x > 0 ? node.upper[1] : node.lower[1]) - from.y;
      const double p = along_x * y, q = along_y * x;
      // Four roundings, and underflow; if anything overflows, the comparison fails.
      return p - q < -(0x1p-49 * (std::fabs(p) + std::fabs(q)) + 0x1p-1060);
    }
  };

  void fill(std::uint32_t number, const std::vector<ShadowPoint>& points, std::size_t begin,
            std::size_t end);
  void unite(std::uint32_t number);

  std::vector<Node> nodes_;             // the children of i are 2 i and 2 i + 1; the root is 1
  std::vector<std::uint32_t> corners_;  // in the order of leaves
  std::vector<std::uint32_t> leaves_;   // of each corner
};

}  // namespace pierce::io
