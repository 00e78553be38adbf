// SPDX-License-Identifier: Apache-2.0
//
// Spaces within spaces: parts of a scene that are so fine, as far from the centre as they lie, that
// the floats of its filter space hardly tell their triangles apart. Each gets a tree in a space of
// its own, and so does what is left.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/tree.h"
#include "scene/geometries.h"
#include "scene/two_level.h"

namespace pierce::scene {

/// The triangles of each such part, and those of the rest last; none if there is no such part.
std::vector<std::vector<std::uint32_t>> fine_parts(const bvh::Tree& tree);

/// A tree over some triangles of the scene, in a space of its own; its leaves have the scene's
/// numbers. `map`: that space.
template <class Real>
bvh::Tree tree_of_part(const Geometries<Real>& scene, const std::vector<std::uint32_t>& triangles,
                       const BuildOptions& options, Extent& extent, space::AffineMap& map);

}  // namespace pierce::scene
