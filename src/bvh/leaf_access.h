// SPDX-License-Identifier: Apache-2.0
//
// Access to leaf contents for both layouts. In a full tree the block is where it lies; of a compact
// leaf, which holds numbers alone, traversal expands the full block from the caller's mesh into
// scratch memory of its own: the very same bytes, so that every bound and every answer is that of
// the full layout.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "bvh/node.h"
#include "bvh/tree.h"

namespace pierce::bvh {

/// Room for one full block, and for reading its rows past their end. Never initialised as a whole.
struct LeafScratch {
  static constexpr std::size_t kBlock = 4 * (10 * kWidth + kLeafHead);
  alignas(64) std::byte bytes[(kBlock + kLeafUnit - 1) / kLeafUnit * kLeafUnit + kLeafSlack];
};

/// Writes the full block of a compact leaf. Costs up to 32 look-ups in the caller's memory.
const float* fetch_leaf(const Tree& tree, std::uint32_t ref, LeafScratch& scratch);

/// The full block of a leaf, its head first. Of a compact tree's it is in the scratch, until that
/// is used again.
inline const float* leaf_block(const Tree& tree, std::uint32_t ref, LeafScratch& scratch) {
  if (tree.layout == Layout::Compact) [[unlikely]]
    return fetch_leaf(tree, ref, scratch);
  return reinterpret_cast<const float*>(tree.leaves.data() +
                                        std::size_t{leaf_offset(ref)} * kLeafUnit);
}

/// The number of triangle i of a full block with `count` of them, whose rows these are.
inline std::uint32_t number_in(const float* rows, std::uint32_t count, std::uint32_t i) {
  return std::bit_cast<LeafNumber>(rows[9 * count + i]);
}

/// The numbers of a leaf's triangles.
inline const LeafNumber* leaf_numbers(const Tree& tree, std::uint32_t ref) {
  const std::size_t rows =
      tree.layout == Layout::Full ? kLeafHead + 9 * std::size_t{leaf_count(ref)} : 0;
  return reinterpret_cast<const LeafNumber*>(tree.leaves.data() +
                                             std::size_t{leaf_offset(ref)} * kLeafUnit) +
         rows;
}

/// The number in leaf `k`, in the order of memory, of a tree that build_over_boxes made.
inline LeafNumber& single_number(Tree& tree, std::uint32_t k) {
  return *reinterpret_cast<LeafNumber*>(tree.leaves.data() + std::size_t{k} * kLeafUnit);
}

}  // namespace pierce::bvh
