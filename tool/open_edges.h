// SPDX-License-Identifier: Apache-2.0
//
// All edges at which meshes are not closed, and the files that list them.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "one_mesh.h"
#include "pierce/closed.h"

namespace pierce::tool {

/// Every edge that is not used as often one way as the other, vertices by position: those that
/// `closedness` counts as unbalanced, in the order of their first triangles, then corners.
template <class Real>
[[nodiscard]] std::vector<EdgeUse> open_edges(MeshView<Real> mesh);

/// Writes them to a .csv file, a line each (see kOpenEdgeColumns; `widths`: see edge_widths), or to
/// a .ply file of vertices and edges, equal positions being one vertex.
template <class Real>
void write_open_edges(const std::filesystem::path& path, const OneMesh<Real>& meshes,
                      const std::vector<EdgeUse>& edges, std::span<const double> widths);

inline constexpr const char* kOpenEdgeColumns =
    "geometry,triangle,from_vertex,to_vertex,forward,backward,"
    "from_x,from_y,from_z,to_x,to_y,to_z,width";

extern template std::vector<EdgeUse> open_edges(MeshView<float>);
extern template std::vector<EdgeUse> open_edges(MeshView<double>);
extern template void write_open_edges(const std::filesystem::path&, const OneMesh<float>&,
                                      const std::vector<EdgeUse>&, std::span<const double>);
extern template void write_open_edges(const std::filesystem::path&, const OneMesh<double>&,
                                      const std::vector<EdgeUse>&, std::span<const double>);

}  // namespace pierce::tool
