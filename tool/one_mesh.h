// SPDX-License-Identifier: Apache-2.0
//
// Several meshes as one, for questions about all of them together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "pierce/error.h"
#include "pierce/types.h"

namespace pierce::tool {

/// Triangles and vertices of all meshes, one mesh after the other. A single mesh is not copied.
template <class Real>
class OneMesh {
 public:
  /// The meshes must outlive this. Throws Error (TooManyTriangles) if there are 2^32 - 1 vertices
  /// or triangles or more.
  explicit OneMesh(std::span<const MeshView<Real>> meshes) {
    std::uint64_t vertex = 0, triangle = 0;
    for (const MeshView<Real>& mesh : meshes) {
      first_vertex_.push_back(static_cast<std::uint32_t>(vertex));
      first_triangle_.push_back(static_cast<std::uint32_t>(triangle));
      vertex += mesh.vertices.size();
      triangle += mesh.triangles.size();
    }
    if (vertex >= kNone || triangle >= kNone) {
      throw Error(ErrorCode::TooManyTriangles,
                  "too many vertices or triangles to take the meshes together; give fewer");
    }
    if (meshes.size() == 1) {
      view_ = meshes[0];
      return;
    }
    vertices_.reserve(vertex);
    triangles_.reserve(triangle);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      vertices_.insert(vertices_.end(), meshes[i].vertices.begin(), meshes[i].vertices.end());
      const std::uint32_t first = first_vertex_[i];
      for (const Triangle& t : meshes[i].triangles) {
        triangles_.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
    view_ = {vertices_, triangles_};
  }
  OneMesh(const OneMesh&) = delete;
  OneMesh& operator=(const OneMesh&) = delete;

  [[nodiscard]] MeshView<Real> view() const { return view_; }
  [[nodiscard]] std::size_t meshes() const { return first_triangle_.size(); }

  /// Which triangle of which mesh a triangle of all is.
  [[nodiscard]] TriangleRef ref(std::uint32_t triangle) const {
    const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
    const auto mesh = static_cast<std::uint32_t>(next - first_triangle_.begin()) - 1;
    return {mesh, triangle - first_triangle_[mesh]};
  }

  /// The number that a vertex of all has in its own mesh.
  [[nodiscard]] std::uint32_t vertex(std::uint32_t mesh, std::uint32_t vertex) const {
    return vertex - first_vertex_[mesh];
  }

 private:
  std::vector<std::uint32_t> first_vertex_, first_triangle_;  // of each mesh
  std::vector<Vec3<Real>> vertices_;
  std::vector<Triangle> triangles_;
  MeshView<Real> view_;
};

}  // namespace pierce::tool
