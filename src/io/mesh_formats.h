// SPDX-License-Identifier: Apache-2.0
//
// One reader for each mesh format. Each takes the whole file as bytes and the name for its
// messages, and throws Error (BadFile) for anything that is not well formed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/mesh.h"

namespace pierce::io {

[[nodiscard]] Mesh read_ply(std::string_view bytes, const std::string& name);
[[nodiscard]] Mesh read_stl(std::string_view bytes, const std::string& name);
[[nodiscard]] Mesh read_obj(std::string_view bytes, const std::string& name);
[[nodiscard]] Mesh read_off(std::string_view bytes, const std::string& name);
/// The files that a .gltf names are looked for beside `name`.
[[nodiscard]] Mesh read_gltf(std::string_view bytes, const std::string& name);

[[nodiscard]] Mesh read_threemf(std::string_view bytes, const std::string& name);

/// Everything else, by Assimp, which must see the file itself (formats name further files).
[[nodiscard]] Mesh read_by_assimp(const std::filesystem::path& path);
/// The same, of a file that holds this text in another encoding.
[[nodiscard]] Mesh read_by_assimp(const std::filesystem::path& path, std::string_view text);
/// Whether that reads files whose names end so (".glb").
[[nodiscard]] bool assimp_reads(const std::string& extension);

[[nodiscard]] bool looks_like_ply(std::string_view bytes);
[[nodiscard]] bool looks_like_binary_stl(std::string_view bytes);
[[nodiscard]] bool looks_like_ascii_stl(std::string_view bytes);
[[nodiscard]] bool looks_like_obj(std::string_view bytes);
[[nodiscard]] bool looks_like_off(std::string_view bytes);
[[nodiscard]] bool looks_like_glb(std::string_view bytes);

}  // namespace pierce::io
