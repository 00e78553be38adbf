// SPDX-License-Identifier: Apache-2.0
#include "io/read_mesh.h"

#include <algorithm>
#include <optional>

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

// What a mesh's name is given to by mistake, and the cure; nothing if it is none of these.
const char* stranger(std::string_view bytes) {
  std::string_view text = without_mark(bytes.substr(0, 1024));
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  constexpr std::string_view kPages[] = {"<!doctype html", "<html", "<head"};
  for (const std::string_view start : kPages) {
    if (same_word(text.substr(0, start.size()), start)) {
      return "is a web page, not a mesh: download the file itself";
    }
  }
  if (text.starts_with("version https://git-lfs")) {
    return "is a pointer of Git LFS, not the file itself: run git lfs pull";
  }
  if (bytes.starts_with("PK\x03\x04")) return "is a ZIP archive: unpack it";
  if (bytes.starts_with("\x1f\x8b")) return "is packed by gzip: unpack it with gunzip";
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return "is packed by zstd: unpack it with unzstd";
  if (bytes.starts_with("\xfd"
                        "7zXZ")) {
    return "is packed by xz: unpack it with unxz";
  }
  if (bytes.starts_with("BZh")) return "is packed by bzip2: unpack it with bunzip2";
  if (bytes.starts_with("%PDF")) return "is a PDF, not a mesh: get the file itself";
  return nullptr;
}

// Formats of Assimp may be packed on purpose.
void refuse_stranger(Reader reader, std::string_view bytes, const std::string& name) {
  if (reader == read_threemf || looks_like_binary_stl(bytes)) return;
  const char* const what = stranger(bytes);
  const std::string extension = std::filesystem::path(name).extension().string();
  const bool ours = reader != nullptr || extension.empty() || !assimp_reads(extension);
  if (what != nullptr && ours) bad_file(name, what);
}

// UTF-16 is read as what it says.
Mesh read_bytes(Reader reader, std::string_view bytes, const std::string& name) {
  refuse_stranger(reader, bytes, name);
  if (reader == read_threemf) return read_threemf(bytes, name);
  const std::optional<std::string> text =
      looks_like_binary_stl(bytes) ? std::nullopt : from_utf16(bytes);
  return read_with(reader, text ? std::string_view(*text) : bytes, name);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const MappedFile file(path);
  const Reader reader = pick_reader(file.bytes(), path.extension().string());
  if (reader != nullptr) return read_bytes(reader, file.bytes(), path.string());
  refuse_stranger(reader, file.bytes(), path.string());
  return read_by_assimp(path);
}

Mesh read_mesh_bytes(std::string_view bytes, const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  const Reader reader = pick_reader(bytes, extension);
  refuse_stranger(reader, bytes, name);
  if (reader == nullptr)
    bad_file(name, "is neither PLY, STL, OBJ, OFF nor glTF: convert it to PLY");
  return read_bytes(reader, bytes, name);
}

}  // namespace pierce::io
