// SPDX-License-Identifier: Apache-2.0
//
// The meshes of the benchmark: made here or found in Debian's packages, the same on every machine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pierce/types.h"
#include "workloads/vector.h"

namespace pierce::bench {

/// Where a picture of the mesh is taken from, and where its light hangs (outside its box).
struct View {
  Double3 eye, look_at, up;
  double half_height = 0.5;  ///< of the picture, at distance 1
  Double3 light;
};

struct Box {
  Double3 lower, upper;
  [[nodiscard]] Double3 center() const { return 0.5 * (lower + upper); }
  [[nodiscard]] double radius() const { return 0.5 * length(upper - lower); }
};

struct Mesh {
  std::string name;
  std::vector<Vec3<float>> vertices;  ///< with room for one more: Embree reads past the last
  std::vector<Triangle> triangles;
  Box box;
  View view;

  [[nodiscard]] MeshView<float> mesh_view() const { return {vertices, triangles}; }
};

struct MeshKind {
  std::string name, description;
  bool by_default;  ///< part of the suite unless it is told otherwise
  Mesh (*make)();
};

[[nodiscard]] const std::vector<MeshKind>& mesh_kinds();

/// One of the kinds by name. Throws Error (InvalidArgument) that lists the names there are.
[[nodiscard]] Mesh make_mesh(const std::string& name);

/// A mesh file, its numbers rounded to float.
[[nodiscard]] Mesh load_mesh(const std::filesystem::path& path);

/// Triangles of a closed sphere of radius 1 around the origin: an icosahedron, each triangle
/// divided into four `levels` times. Every vertex is rounded to float after normalising.
[[nodiscard]] Mesh make_icosphere(int levels);

/// How a mesh is looked at: from a direction, at a distance in which a sphere of `filled` times the
/// mesh's radius just fills the picture; lit from the side, `light_height` above the horizon.
struct Framing {
  Double3 direction, up;
  double filled = 0.6;
  double light_height = 0.8;
};
inline constexpr Framing kPortrait{{0.3, 0.35, 1}, {0, 1, 0}};
inline constexpr Framing kLandscape{{-0.5, -0.9, 0.6}, {0, 0, 1}, 0.5, 0.3};

/// Fills in box and view, and makes room for a spare vertex.
void finish(Mesh& mesh, const Framing& framing);

}  // namespace pierce::bench
