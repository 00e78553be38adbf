// SPDX-License-Identifier: Apache-2.0
//
// Writing and reading one leaf block, full or compact; node.h is the data sheet of both.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bvh/node.h"
#include "bvh/primitives.h"
#include "bvh/tree.h"

namespace pierce::bvh {

/// Size of a block of n triangles in units of kLeafUnit.
inline std::uint32_t leaf_units(Layout layout, std::uint32_t n) {
  const std::uint32_t bytes = layout == Layout::Full ? 4 * (10 * n + kLeafHead) : 4 * n;
  return (bytes + kLeafUnit - 1) / kLeafUnit;
}

/// What a full block holds.
struct LeafContents {
  std::uint32_t count;
  std::uint32_t primitive[kWidth];
  float corner[kWidth][9];  // a, b, c
  float edge;               // E
  float reach;
};

/// The largest |component| of the edges b - a and c - a, of the corners and of their float copies:
/// whichever the error analysis means, the block's E covers it.
double largest_edge(const Corners& t);

/// Writes the block of n triangles (1 to 8) at `place`, its padding zeroed. Returns the axes across
/// which all of them stand, as far as is known: of a compact block none.
Axes write_leaf_block(Layout layout, std::byte* place, const Primitives& primitives,
                      const std::uint32_t* numbers, std::uint32_t n);

/// Only the numbers of its n primitives.
void read_leaf_numbers(Layout layout, const std::byte* place, std::uint32_t n,
                       std::uint32_t* numbers);

/// A full one.
LeafContents read_leaf_block(const std::byte* place, std::uint32_t n);

}  // namespace pierce::bvh
