// SPDX-License-Identifier: Apache-2.0
//
// Where to cut a set of primitives in two: the surface area heuristic over bins of box centres.
#pragma once

#include <cstdint>

#include "bvh/box.h"
#include "bvh/node.h"
#include "bvh/primitive_refs.h"

namespace pierce::bvh {

/// A plane across the centres of boxes. Primitives with a centre before it go left.
struct Split {
  int axis = -1;  // -1: no plane separates the centres
  float offset = 0, scale = 0, bound = 0;
  float cost = 0;         // area times blocks, left plus right
  float common_area = 0;  // half-area that the boxes of both sides have in common

  [[nodiscard]] bool found() const { return axis >= 0; }
  [[nodiscard]] bool is_left(const PrimitiveRef& ref) const {
    return (ref.box.lower[axis] + ref.box.upper[axis] - offset) * scale < bound;
  }
};

/// Leaf blocks that so many primitives need: a test takes eight at once, whatever the fill. For a
/// sample, each ref of which stands for `weight` primitives, on average.
inline float blocks(std::uint32_t count, float weight) {
  return weight == 1.0F ? static_cast<float>((count + kWidth - 1) / kWidth)
                        : static_cast<float>(count) * weight * (1.0F / kWidth);
}

/// The cheapest plane for `count` refs (two or more) by the heuristic: area times the number of
/// leaf blocks of eight, left plus right. `weight` is how many primitives each ref stands for when
/// the refs are a sample. Both sides get at least one of the refs.
Split find_split(const PrimitiveRef* refs, std::uint32_t count, float weight);

}  // namespace pierce::bvh
