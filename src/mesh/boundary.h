// SPDX-License-Identifier: Apache-2.0
//
// Where a surface ends.
#pragma once

#include <cstdint>
#include <vector>

#include "pierce/options.h"
#include "pierce/types.h"

namespace pierce::mesh {

/// An edge that triangles use more often this way than the other.
struct OpenEdge {
  std::uint32_t from, to;  ///< vertices, each the first one at its position
  std::uint32_t times;     ///< how much more often
};

/// All of them, by vertices, which are the same if their positions are; a triangle of which two
/// corners are the same vertex has no edges. As many begin at each vertex as end there. Throws
/// Error (Stopped).
template <class Real>
std::vector<OpenEdge> open_edges(MeshView<Real> mesh, const WorkOptions& work);

}  // namespace pierce::mesh
