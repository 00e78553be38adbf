// SPDX-License-Identifier: Apache-2.0
//
// Where to cut a set of primitives in two: the surface area heuristic over bins of box centres.
#pragma once

#include <cstdint>

#include "bvh/box.h"
#include "bvh/primitive_refs.h"

namespace pierce::bvh {

/// A plane across the centres of boxes. Primitives with a centre before it go left.
struct Split {
  int axis = -1;  // -1: no plane separates the centres
  float offset = 0, scale = 0, bound = 0;

  [[nodiscard]] bool found() const { return axis >= 0; }
  [[nodiscard]] bool is_left(const PrimitiveRef& ref) const {
    return (ref.box.lower[axis] + ref.box.upper[axis] - offset) * scale < bound;
  }
};

/// The cheapest plane for `count` refs (two or more) by the heuristic: area times the number of
/// leaf blocks of eight, left plus right. `weight` is how many primitives each ref stands for when
/// the refs are a sample. Both sides get at least one of the refs.
Split find_split(const PrimitiveRef* refs, std::uint32_t count, float weight);

}  // namespace pierce::bvh
