// SPDX-License-Identifier: Apache-2.0
//
// Top-down build of the binary tree by the surface area heuristic over bins.
#pragma once

#include <cstdint>

#include "bvh/binary_tree.h"
#include "bvh/primitive_refs.h"
#include "support/build_control.h"

namespace pierce::bvh {

/// What distinguishes the qualities.
struct BinaryBuildSettings {
  std::uint32_t stop_at = kWidth;       // refs of a node that is not split further, 1 to 8
  std::uint32_t sample = 8192;          // refs by which the plane of a larger node is chosen
  bool spatial_splits = false;          // may cut primitives, as far as the capacity goes
  std::uint32_t largest_leaf = kWidth;  // that the collapse may make of what was split further
};

/// About how many steps build_binary tells the control of.
std::uint64_t binary_build_steps(std::uint32_t count);

/// Builds over `count` refs (at least one), which are moved between two buffers of `capacity` refs
/// and left unspecified. The tree is the same for every number of threads.
BinaryTree build_binary(PrimitiveRef* refs, PrimitiveRef* scratch, std::uint32_t count,
                        std::uint32_t capacity, const Primitives& primitives,
                        const BinaryBuildSettings& settings, BuildControl& control);

}  // namespace pierce::bvh
