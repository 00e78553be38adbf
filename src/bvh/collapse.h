// SPDX-License-Identifier: Apache-2.0
//
// From the decisions in the binary tree to wide nodes and leaf blocks in memory.
#pragma once

#include "bvh/binary_tree.h"
#include "bvh/build_control.h"
#include "bvh/primitive_refs.h"
#include "bvh/tree.h"

namespace pierce::bvh {

/// Gathers binary nodes into wide ones and writes nodes and leaf blocks, both depth-first.
Tree collapse(const BinaryTree& binary, const HugeBuffer<PrimitiveRef>& refs,
              const Primitives& primitives, BuildControl& control);

}  // namespace pierce::bvh
