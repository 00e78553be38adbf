// SPDX-License-Identifier: Apache-2.0
//
// In which order a ray meets the children of a node, by the octant of its direction: near enough
// the true one, and known beforehand.
#pragma once

#include <cstdint>

#include "bvh/node.h"

namespace pierce::bvh {

/// Sets `order` from the boxes, and what else is in its words to 0. Of two children that a plane
/// across an axis parts, the one on the near side comes first (by most axes); else the one whose
/// centre is nearer along the diagonal of the octant: so what is small comes before the ground that
/// it stands on.
void order_children(Node& node);

}  // namespace pierce::bvh
