// SPDX-License-Identifier: Apache-2.0
//
// Meshes out, as this library's own readers read them back bit by bit.
#pragma once

#include <array>
#include <filesystem>
#include <span>

#include "pierce/types.h"

namespace pierce::io {

/// Coordinates are written in the type they have (property float or double). The file appears
/// under its name only when it is complete.
template <class Real>
void write_ply(const std::filesystem::path& path, MeshView<Real> mesh);

/// By the name: .ply as above, .obj, .stl (binary) or .npz with the arrays `vertices` (n, 3) and
/// `triangles` (m, 3). OBJ has the shortest digits that are the same doubles. Throws Error
/// (BadFile) if the file cannot be written, or if STL, whose numbers are floats, cannot hold a
/// vertex.
template <class Real>
void write_mesh(const std::filesystem::path& path, MeshView<Real> mesh);

/// The extensions that write_mesh knows.
inline constexpr std::array<const char*, 4> kMeshExtensions = {".ply", ".obj", ".stl", ".npz"};

extern template void write_mesh(const std::filesystem::path&, MeshView<float>);
extern template void write_mesh(const std::filesystem::path&, MeshView<double>);
extern template void write_ply(const std::filesystem::path&, MeshView<float>);
extern template void write_ply(const std::filesystem::path&, MeshView<double>);

}  // namespace pierce::io
