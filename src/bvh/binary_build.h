// SPDX-License-Identifier: Apache-2.0
//
// Top-down build of the binary tree by the surface area heuristic over bins.
#pragma once

#include "bvh/binary_tree.h"
#include "bvh/build_control.h"
#include "bvh/primitive_refs.h"

namespace pierce::bvh {

/// Builds over all refs (at least one) and orders them so that every subtree owns a contiguous run.
BinaryTree build_binary(HugeBuffer<PrimitiveRef>& refs, BuildControl& control);

}  // namespace pierce::bvh
