// SPDX-License-Identifier: Apache-2.0
//
// Geometries of a scene as one mesh, for what is asked of the surface as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "pierce/error.h"
#include "scene/geometries.h"
#include "support/stop_poll.h"

namespace pierce::scene {

// Geometries as one mesh.
template <class Real>
struct OneMesh {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> first_vertex;  // of each geometry
  std::vector<std::uint32_t> primitives;    // of each triangle; none if they are the same

  [[nodiscard]] MeshView<Real> view() const { return {vertices, triangles}; }

  /// Of those in `which`, by their numbers. Throws Error (TooManyTriangles) if there are too many
  /// vertices to do `what`.
  OneMesh(const Geometries<Real>& geometries, const std::vector<std::uint32_t>& which,
          const StopPoll& stop, const std::string& what, const std::string& cure)
      : first_vertex(geometries.meshes().size()) {
    const auto meshes = geometries.meshes();
    std::uint64_t count = 0;
    for (const std::uint32_t i : which) count += meshes[i].vertices.size();
    if (count >= kNone) {
      throw Error(ErrorCode::TooManyTriangles, "too many vertices to " + what + ": " +
                                                   std::to_string(count) + ", at most " +
                                                   std::to_string(kNone - 1) + " will do" + cure);
    }
    const bool some = which.size() != meshes.size();
    for (const std::uint32_t i : which) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      first_vertex[i] = first;
      for (std::uint32_t k = 0; k < meshes[i].vertices.size(); ++k) {
        vertices.push_back(geometries.vertex(i, k));
      }
      for (std::uint32_t k = 0; k < meshes[i].triangles.size(); ++k) {
        stop.now();
        const Triangle& t = meshes[i].triangles[k];
        triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        if (some) primitives.push_back(geometries.primitive({i, k}));
      }
    }
  }
};

inline std::vector<std::uint32_t> all_of(std::size_t geometries) {
  std::vector<std::uint32_t> all(geometries);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

}  // namespace pierce::scene
