// SPDX-License-Identifier: Apache-2.0
//
// Boxes of the builder: four-lane floats (x, y, z and one lane to spare), rounded outward.
//
// The compiler's vector extension (GCC, Clang, on every architecture) instead of intrinsics: the
// builder needs four lanes and no more, and Highway stays in kernels/.
#pragma once

#include <algorithm>
#include <cmath>

#include "bvh/node.h"
#include "bvh/primitives.h"
#include "exact/round_outward.h"
#include "predicate/bounds.h"

namespace pierce::bvh {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }

using exact::round_down;
using exact::round_up;

/// An axis-aligned box; the spare lanes mean nothing. The default holds nothing.
struct Box {
  Float4 lower = {kEmptyPlane, kEmptyPlane, kEmptyPlane, kEmptyPlane};
  Float4 upper = {-kEmptyPlane, -kEmptyPlane, -kEmptyPlane, -kEmptyPlane};

  void grow(const Box& other) {
    lower = min4(lower, other.lower);
    upper = max4(upper, other.upper);
  }
  void grow(Float4 point) {
    lower = min4(lower, point);
    upper = max4(upper, point);
  }
};

inline Box merged(Box a, const Box& b) {
  a.grow(b);
  return a;
}

/// What a node's planes are of this box: moved outward, to cover what the box test loses of them.
inline Box padded(const Box& box) {
  Box wider;
  for (int k = 0; k < 3; ++k) {
    const auto low = static_cast<double>(box.lower[k]), high = static_cast<double>(box.upper[k]);
    wider.lower[k] = round_down(low - std::fabs(low) * bounds::kBoxPlane);
    wider.upper[k] = round_up(high + std::fabs(high) * bounds::kBoxPlane);
  }
  return wider;
}

/// Writes a box to a node's child.
inline void set_child_box(Node& node, int lane, const Box& box) {
  for (int k = 0; k < 3; ++k) {
    node.lower[k][lane] = box.lower[k];
    node.upper[k][lane] = box.upper[k];
  }
}

/// The box of a node's child; an unused lane's holds nothing.
inline Box child_box(const Node& node, int lane) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lower[k] = node.lower[k][lane];
    box.upper[k] = node.upper[k][lane];
  }
  return box;
}

/// Half the surface of the box, which must not be empty.
inline float half_area(const Box& box) {
  const Float4 size = box.upper - box.lower;
  return size[0] * (size[1] + size[2]) + size[1] * size[2];
}

/// The smallest float box around a triangle.
inline Box box_of(const Corners& t) {
  const auto low = [](double a, double b, double c) { return round_down(std::min({a, b, c})); };
  const auto high = [](double a, double b, double c) { return round_up(std::max({a, b, c})); };
  const Float4 lower = {low(t.a.x, t.b.x, t.c.x), low(t.a.y, t.b.y, t.c.y),
                        low(t.a.z, t.b.z, t.c.z), 0.0F};
  const Float4 upper = {high(t.a.x, t.b.x, t.c.x), high(t.a.y, t.b.y, t.c.y),
                        high(t.a.z, t.b.z, t.c.z), 0.0F};
  return Box{lower, upper};
}

}  // namespace pierce::bvh
