// SPDX-License-Identifier: Apache-2.0
//
// The tree of kernels/points/winding.h over the triangles of a search tree.
#pragma once

#include "bvh/tree.h"
#include "kernels/points/winding.h"
#include "pierce/options.h"
#include "scene/geometries.h"

namespace pierce::scene {

/// Every triangle stands in one leaf of the tree. Throws Error (Stopped).
template <class Real>
kernels::WindingTree winding_tree(const bvh::Tree& tree, const Geometries<Real>& geometries,
                                  const WorkOptions& work);

}  // namespace pierce::scene
