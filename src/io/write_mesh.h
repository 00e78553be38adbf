// SPDX-License-Identifier: Apache-2.0
//
// Meshes out, as binary little-endian PLY: what this library's own reader reads back bit by bit.
#pragma once

#include <filesystem>
#include <span>

#include "pierce/types.h"

namespace pierce::io {

/// Coordinates are written in the type they have (property float or double). The file appears
/// under its name only when it is complete.
template <class Real>
void write_ply(const std::filesystem::path& path, MeshView<Real> mesh);

extern template void write_ply(const std::filesystem::path&, MeshView<float>);
extern template void write_ply(const std::filesystem::path&, MeshView<double>);

}  // namespace pierce::io
