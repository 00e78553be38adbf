// SPDX-License-Identifier: Apache-2.0
//
// The one door for meshes: looks at what the file holds, then at its name, and calls the reader.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/mesh.h"

namespace pierce::io {

/// Reads PLY, STL, OBJ, OFF, glTF and 3MF with this library's own exact readers, and whatever else
/// Assimp knows (3DS, DAE, FBX ...). The first bytes decide if they can, else the extension. What
/// gzip or zstd packed is unpacked in memory (io/packed.h), unless the format is Assimp's.
///
/// A file without any triangle gives a mesh without triangles. NaN and infinite coordinates are
/// read as they stand (building a scene names the vertex). Anything that is not a well-formed mesh
/// throws Error (BadFile) with one line: file, line or byte, what is wrong, what to do.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path);

/// The same for a file already in memory; `name` stands in messages and its extension counts.
/// Only this library's own formats.
[[nodiscard]] Mesh read_mesh_bytes(std::string_view bytes, const std::string& name);

}  // namespace pierce::io
