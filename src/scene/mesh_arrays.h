// SPDX-License-Identifier: Apache-2.0
//
// Meshes in arrays of any layout: viewed where they lie right, else copied, each index looked at.
#pragma once

#include <string>

#include "pierce/mesh.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// The mesh, with what has to be copied in `own`. Throws Error, see Mesh::from; indices that need
/// no copy are left to whoever looks at the view, unless they are negative. `where`: " of geometry
/// 2", or nothing if there is only one. Throws Error (Stopped) when the caller wants to stop.
template <class Real>
[[nodiscard]] MeshView<Real> view_or_copy(const MeshArrays<Real>& arrays, const std::string& where,
                                          const StopPoll& stop, Mesh<Real>& own);

}  // namespace pierce::scene
