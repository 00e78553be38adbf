// SPDX-License-Identifier: Apache-2.0
//
// Meshes made to be hard: `pierce check --generate NAME`, and all of them for --suite.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pierce/types.h"

namespace pierce::tool {

template <class Real>
struct HardMesh {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;

  [[nodiscard]] MeshView<Real> view() const { return {vertices, triangles}; }
};

struct HardMeshKind {
  std::string_view name;
  std::string_view what;
};

[[nodiscard]] std::span<const HardMeshKind> hard_mesh_kinds();

/// The mesh of that name; the name is one of hard_mesh_kinds(). Deterministic.
template <class Real>
[[nodiscard]] HardMesh<Real> make_hard_mesh(std::string_view name);

extern template HardMesh<float> make_hard_mesh(std::string_view);
extern template HardMesh<double> make_hard_mesh(std::string_view);

}  // namespace pierce::tool
