// SPDX-License-Identifier: Apache-2.0
//
// What a tree costs by the surface area heuristic: the unit in which the builder optimises and in
// which trees of all qualities are compared.
#pragma once

#include "bvh/tree.h"

namespace pierce::bvh {

/// Cost of testing the eight boxes of one wide node, the unit of all costs, and of one leaf block
/// of any fill (eight lanes are tested whatever they hold).
inline constexpr float kNodeCost = 1.0F;
inline constexpr float kLeafCost = 1.0F;

/// The cost that a random line through the root's box is expected to meet when it stops nowhere:
/// the sum over nodes and leaves of cost times area, over the root's area. For a root without
/// area, as if every line met everything.
double sah_cost(const Tree& tree);

}  // namespace pierce::bvh
