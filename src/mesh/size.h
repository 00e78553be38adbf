// SPDX-License-Identifier: Apache-2.0
//
// Volume and area of a mesh.
#pragma once

#include "pierce/options.h"
#include "pierce/types.h"

namespace pierce::mesh {

struct Size {
  double volume, area;
};

/// All vertices of the triangles must exist and be finite. On the threads of the caller. Throws
/// Error (Stopped).
template <class Real>
Size size_of(MeshView<Real> mesh, const WorkOptions& work);

}  // namespace pierce::mesh
