// SPDX-License-Identifier: Apache-2.0
//
// How binary nodes are gathered into wide ones: "the cheapest forest of at most i wide subtrees
// that covers this node", for i = 1..8, by dynamic programming from the leaves up (Ylitie, Karras,
// Laine 2017, section 3).
#pragma once

#include <cstdint>

#include "bvh/binary_tree.h"
#include "support/build_control.h"

namespace pierce::bvh {

/// Makes the choices of all nodes. Leaves hold up to `largest_leaf` primitives.
void choose_forests(BinaryTree& tree, std::uint32_t largest_leaf, BuildControl& control);

}  // namespace pierce::bvh
