// SPDX-License-Identifier: Apache-2.0
//
// One primitive of a glTF mesh: vertices and the triangles over them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "io/gltf_file.h"
#include "pierce/types.h"

namespace pierce::io {

struct GltfPrimitive {
  GltfNumbers positions;
  std::vector<Triangle> triangles;
  std::vector<Vec3<float>> normals, colors;  ///< one a vertex, or none
  std::vector<std::array<float, 2>> texcoords;
};

/// Nothing if the primitive is of points or lines, or has no positions (which is a warning).
[[nodiscard]] std::optional<GltfPrimitive> read_gltf_primitive(GltfFile& file,
                                                               const JsonView& primitive);

}  // namespace pierce::io
