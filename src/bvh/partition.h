// SPDX-License-Identifier: Apache-2.0
//
// Moving the primitives of a node to the two sides of a plane, from one buffer to another.
//
// Out of place, because then no branch depends on the data: a ref is written to both fronts and
// one of them advances. The order of the result depends on the input alone, not on threads.
#pragma once

#include <cstdint>

#include "bvh/binning.h"
#include "bvh/primitive_refs.h"
#include "support/build_control.h"

namespace pierce::bvh {

/// Copies `count` refs: those on the left upward from `left`, the others downward from `right`
/// (which lie at least `count` apart). Returns how many are on the left.
inline std::uint32_t partition(const PrimitiveRef* from, std::uint32_t count, const Split& split,
                               PrimitiveRef* left, PrimitiveRef* right) {
  const PrimitiveRef* begin = left;
  for (std::uint32_t i = 0; i < count; ++i) {
    const PrimitiveRef ref = from[i];
    const bool is_left = split.is_left(from[i]);
    *left = ref;
    right[-1] = ref;
    left += is_left ? 1 : 0;
    right -= is_left ? 0 : 1;
  }
  return static_cast<std::uint32_t>(left - begin);
}

/// The same with all threads, for large counts (the order on the right side differs). Polls the
/// control.
std::uint32_t partition_parallel(const PrimitiveRef* from, std::uint32_t count, const Split& split,
                                 PrimitiveRef* left, PrimitiveRef* right,
                                 const BuildControl& control);

}  // namespace pierce::bvh
