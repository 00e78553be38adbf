// SPDX-License-Identifier: Apache-2.0
//
// From the decisions in the binary tree to wide nodes and leaf blocks in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bvh/binary_tree.h"
#include "bvh/tree.h"
#include "support/build_control.h"

namespace pierce::bvh {

/// Gathers binary nodes into wide ones and writes nodes and leaf blocks into `tree`, both
/// depth-first: the inner children of a node side by side, then what is below each of them.
/// `tree.leaves` is memory of at least max_leaf_bytes() and is left with the right size.
void collapse(const BinaryTree& binary, const Primitives& primitives, BuildControl& control,
              Tree& tree);

/// What the leaf blocks of n primitives take at most, slack included.
std::size_t max_leaf_bytes(std::uint32_t n);

}  // namespace pierce::bvh
