// SPDX-License-Identifier: Apache-2.0
//
// Writing the nodes of the compact tree; compact_node.h is the data sheet.
#pragma once

#include "bvh/box.h"
#include "bvh/tree.h"

namespace pierce::bvh {

/// Plane q of a frame, as the traversal will compute it.
float plane_of(std::uint8_t q, float step, float origin);

/// The node with its boxes rounded outward to steps.
CompactNode quantise(const Node& node);

/// Turns the full nodes of a tree into compact ones.
void quantise(Tree& tree);

/// Box of a child as the traversal sees it; an unused lane's is inside out.
Box child_box(const CompactNode& node, int lane);
Box child_box(const Node& node, int lane);

}  // namespace pierce::bvh
