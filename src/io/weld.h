// SPDX-License-Identifier: Apache-2.0
//
// Vertices of a mesh that are at one place, or nearly, made one: for files that give each triangle
// corners of its own, or whose parts were rounded apart.
#pragma once

#include <cstdint>
#include <vector>

#include "pierce/types.h"
#include "support/stop_poll.h"

namespace pierce::io {

template <class Real>
struct WeldedMesh {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;
  /// For each vertex that there was: which one it is now.
  std::vector<std::uint32_t> vertex_of;
  /// Triangles of which two corners are one vertex now; they are left out of `triangles`.
  std::uint64_t collapsed = 0;
  double farthest = 0;  ///< how far a vertex was moved, at most; rounded
};

/// In the order of the mesh, each vertex becomes the first kept one that is at most `distance`
/// away, or else is kept itself. So kept vertices keep their coordinates and are further than
/// `distance` apart, none moves further than that, and the result depends on nothing but the order
/// of the vertices. Distances are compared exactly; with 0 only equal positions merge (-0 is 0).
/// Vertices that are not finite stay as they are. Triangles keep their order.
///
/// Throws Error (InvalidArgument) if the distance is negative, infinite or NaN, (IndexOutOfRange)
/// if a triangle names a missing vertex, (Stopped) if the caller wants to stop. Takes about 40
/// bytes of memory a vertex, one thread, and time in proportion to the mesh.
template <class Real>
[[nodiscard]] WeldedMesh<Real> weld(MeshView<Real> mesh, double distance,
                                    scene::StopPoll stop = {});

extern template WeldedMesh<float> weld(MeshView<float>, double, scene::StopPoll);
extern template WeldedMesh<double> weld(MeshView<double>, double, scene::StopPoll);

}  // namespace pierce::io
