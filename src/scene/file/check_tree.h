// SPDX-License-Identifier: Apache-2.0
//
// Whether a search tree from a file may be traversed, whatever its bytes: every reference leads to
// a place that is there, every node is reached once and none too deep, an unused child can be
// entered by no ray, and a node's orders name each child once. Boxes and copies may be anything: at
// worst a hit is lost.
#pragma once

#include <cstdint>

#include "bvh/tree.h"

namespace pierce::scene {

/// What is wrong with it, or nullptr. Looks at the nodes and not at the leaves, on the threads that
/// parallel work has.
[[nodiscard]] const char* fault_of(const bvh::Tree& tree, std::uint32_t primitives);

/// The same of the leaves: whether each names triangles that are there.
[[nodiscard]] const char* fault_of_leaves(const bvh::Tree& tree, std::uint32_t primitives);

}  // namespace pierce::scene
