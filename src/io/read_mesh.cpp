// SPDX-License-Identifier: Apache-2.0
#include "io/read_mesh.h"

#include "io/bad_file.h"
#include "io/mapped_file.h"
#include "io/mesh_formats.h"
#include "io/text_cursor.h"
#include "io/text_encoding.h"

namespace pierce::io {
namespace {

using Reader = Mesh (*)(std::string_view, const std::string&);

// What cannot be anything else goes first (a binary STL by its size: its title may be any bytes),
// then what the name says, then what it might well be; nullptr leaves the file to Assimp.
Reader pick_reader(std::string_view bytes, const std::string& extension) {
  if (looks_like_binary_stl(bytes)) return read_stl;
  const std::string_view text = without_mark(bytes);
  if (looks_like_ply(text)) return read_ply;
  if (looks_like_off(text)) return read_off;
  if (looks_like_glb(bytes)) return read_gltf;
  if (same_word(extension, ".stl")) return read_stl;
  if (same_word(extension, ".obj")) return read_obj;
  if (same_word(extension, ".ply")) return read_ply;
  if (same_word(extension, ".off")) return read_off;
  if (same_word(extension, ".gltf") || same_word(extension, ".glb")) return read_gltf;
  if (same_word(extension, ".3mf")) return read_threemf;
  if (!extension.empty() && assimp_reads(extension)) return nullptr;
  if (looks_like_ascii_stl(text)) return read_stl;
  if (looks_like_obj(text)) return read_obj;
  return nullptr;
}

Mesh read_with(Reader reader, std::string_view bytes, const std::string& name) {
  return reader(looks_like_binary_stl(bytes) ? bytes : without_mark(bytes), name);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const MappedFile file(path);
  const Reader reader = pick_reader(file.bytes(), path.extension().string());
  return reader != nullptr ? read_with(reader, file.bytes(), path.string()) : read_by_assimp(path);
}

Mesh read_mesh_bytes(std::string_view bytes, const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  const Reader reader = pick_reader(bytes, extension);
  if (reader == nullptr)
    bad_file(name, "is neither PLY, STL, OBJ, OFF nor glTF: convert it to PLY");
  return read_with(reader, bytes, name);
}

}  // namespace pierce::io
