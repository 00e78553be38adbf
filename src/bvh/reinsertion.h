// SPDX-License-Identifier: Apache-2.0
//
// Second thoughts about the upper part of a binary tree: what was divided top-down, by planes,
// often leaves large boxes where they enlarge others.
#pragma once

#include "bvh/binary_tree.h"
#include "support/build_control.h"

namespace pierce::bvh {

/// Takes the subtrees with the largest boxes out of the tree, one after another, and puts each in
/// again where that makes the sum of all areas least (Bittner, Hapala, Havran 2013). Before the
/// choices of forests are made. Deterministic; takes a few per cent of the time of a build.
void reinsert_largest(BinaryTree& tree, BuildControl& control);

}  // namespace pierce::bvh
