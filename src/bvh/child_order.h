// SPDX-License-Identifier: Apache-2.0
//
// In which order a ray meets the children of a node, by the octant of its direction: near enough
// the true one, and known beforehand.
#pragma once

#include <cstdint>

#include "bvh/node.h"

namespace pierce::bvh {

/// Sets `order` from the boxes: for each octant the children's centres along its diagonal.
void order_children(Node& node);

}  // namespace pierce::bvh
