// SPDX-License-Identifier: Apache-2.0
//
// Triangles that lie in one place: the same three corner positions, in whatever order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pierce/types.h"
#include "support/stop_poll.h"

namespace pierce::mesh {

struct Coincident {
  /// Triangles with the corners of an earlier one, in ascending order.
  std::vector<std::uint32_t> repeats;
  /// Of each set in one place, twice the smaller number of those that face one way and those that
  /// face the other: they cancel, for winding numbers at least. Those of which two corners are one
  /// do not count.
  std::uint64_t cancelling = 0;
};

/// Takes 32 bytes a triangle and 16 or 32 a vertex while it works. Throws Error (Stopped).
template <class Real>
Coincident coincident_triangles(MeshView<Real> mesh, const scene::StopPoll& stop);

extern template Coincident coincident_triangles(MeshView<float>, const scene::StopPoll&);
extern template Coincident coincident_triangles(MeshView<double>, const scene::StopPoll&);

}  // namespace pierce::mesh
