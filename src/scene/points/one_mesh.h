// SPDX-License-Identifier: Apache-2.0
//
// All geometries of a scene as one mesh, for what is asked of the surface as a whole.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pierce/error.h"
#include "pierce/types.h"
#include "support/stop_poll.h"

namespace pierce::scene {

template <class Real>
struct OneMesh {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> first_vertex;  // of each geometry

  /// Throws Error (TooManyTriangles) if there are too many vertices to do `what`.
  OneMesh(std::span<const MeshView<Real>> meshes, const StopPoll& stop, const std::string& what,
          const std::string& cure) {
    std::uint64_t count = 0;
    for (const MeshView<Real>& mesh : meshes) count += mesh.vertices.size();
    if (count >= kNone) {
      throw Error(ErrorCode::TooManyTriangles, "too many vertices to " + what + ": " +
                                                   std::to_string(count) + ", at most " +
                                                   std::to_string(kNone - 1) + " will do" + cure);
    }
    for (const MeshView<Real>& mesh : meshes) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      first_vertex.push_back(first);
      vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      for (const Triangle& t : mesh.triangles) {
        stop.now();
        triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
  }
};

}  // namespace pierce::scene
