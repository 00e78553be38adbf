// SPDX-License-Identifier: Apache-2.0
//
// Whether a surface is closed, in words.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "one_mesh.h"
#include "pierce/closed.h"
#include "support/count_words.h"

namespace pierce::tool {

template <class Real>
[[nodiscard]] std::string place_text(const Vec3<Real>& p) {
  return fmt::format("({}, {}, {})", p.x, p.y, p.z);
}

template <class Real>
[[nodiscard]] std::string triangle_text(const OneMesh<Real>& meshes, std::uint32_t triangle) {
  const auto [geometry, index] = meshes.ref(triangle);
  return meshes.meshes() == 1 ? fmt::format("triangle {}", index)
                              : fmt::format("triangle {} of geometry {}", index, geometry);
}

/// "edge 3-7 of triangle 12, (0, 0, 0) to (1, 0, 0), ..."
template <class Real>
[[nodiscard]] std::string describe(const EdgeUse& edge, const OneMesh<Real>& meshes) {
  const auto vertices = meshes.view().vertices;
  const std::uint32_t geometry = meshes.ref(edge.triangle).geometry;
  std::string text =
      fmt::format("edge {}-{} of {}, {} to {}, ", meshes.vertex(geometry, edge.from),
                  meshes.vertex(geometry, edge.to), triangle_text(meshes, edge.triangle),
                  place_text(vertices[edge.from]), place_text(vertices[edge.to]));
  if (edge.other_triangle == kNone) return text + "belongs to no other triangle";
  if (edge.forward == 2 && edge.backward == 0) {
    return text + "runs the same way in " + triangle_text(meshes, edge.other_triangle);
  }
  return text + fmt::format("is used {} that way, {} the other", times(edge.forward),
                            times(edge.backward));
}

/// Whether the surface is closed, and where it is not.
template <class Real>
[[nodiscard]] std::string closed_text(const OneMesh<Real>& meshes, SameVertex same) {
  const Closedness c = closedness(meshes.view(), same);
  if (c.closed) return "yes";
  if (c.balanced) {
    return fmt::format("yes, but surfaces meet in {} of {}; the first: {}",
                       grouped(c.crowded_edges), counted(c.edges, "edge", "edges"),
                       describe(*c.first_crowded, meshes));
  }
  if (c.watertight) {
    return fmt::format("yes, with T-junctions: {} of {} pair piece by piece; the first: {}",
                       grouped(c.unbalanced_in_pieces), counted(c.edges, "edge", "edges"),
                       describe(*c.first_unbalanced, meshes));
  }
  return fmt::format("no: {} of {} open, {} more not used once each way; the first: {}",
                     grouped(c.open_edges), counted(c.edges, "edge", "edges"),
                     grouped(c.unbalanced_edges - c.open_edges),
                     describe(*c.first_unbalanced, meshes));
}

}  // namespace pierce::tool
