// SPDX-License-Identifier: Apache-2.0
#include "io/read_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "io/bad_file.h"
#include "io/mapped_file.h"
#include "io/mesh_formats.h"
#include "io/packed.h"
#include "io/text_cursor.h"
#include "io/text_encoding.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

using Reader = Mesh (*)(std::string_view, const std::string&);

bool has_facets(std::string_view text) {
  const std::string_view start = text.substr(0, 4096);
  return start.find("facet") != start.npos || start.find("FACET") != start.npos;
}

bool is_obj_text(std::string_view text) {
  return looks_like_obj(text) && !looks_like_ascii_stl(text) &&
         text.substr(0, 256).find('\0') == text.npos;
}

// What cannot be anything else goes first (a binary STL by its size: its title may be any bytes),
// then what the name says, then what it might well be; nullptr leaves the file to Assimp.
Reader pick_reader(std::string_view bytes, const std::string& extension) {
  if (looks_like_binary_stl(bytes)) return read_stl;
  const std::string_view text = without_padding(without_mark(bytes));
  if (looks_like_ply(text)) return read_ply;
  if (looks_like_off(text)) return read_off;
  if (looks_like_glb(bytes)) return read_gltf;
  if (looks_like_ascii_stl(text) && has_facets(text)) return read_stl;
  if (same_word(extension, ".stl")) return is_obj_text(text) ? read_obj : read_stl;
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
  if (looks_like_binary_stl(bytes)) return reader(bytes, name);
  const std::string_view all = without_mark(bytes);
  const std::string_view text = reader == read_ply ? all : without_padding(all);
  Mesh mesh = reader(text, name);
  if (text.size() != all.size()) {
    mesh.warnings.push_back(
        fmt::format("{} behind the end of the text left out",
                    counted(all.size() - text.size(), "empty byte", "empty bytes")));
  }
  return mesh;
}

constexpr const char* kUtf32 = "is text in UTF-32: save it as UTF-8";

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
  if (packing_of(bytes) != Packing::None) return "is packed more than once: unpack it";
  if (bytes.starts_with("\xfd"
                        "7zXZ")) {
    return "is packed by xz: unpack it with unxz";
  }
  if (bytes.starts_with("BZh")) return "is packed by bzip2: unpack it with bunzip2";
  if (bytes.size() > 262 && bytes.substr(257, 5) == "ustar") {
    return "is a TAR archive: unpack it with tar";
  }
  if (is_utf32(bytes)) return kUtf32;
  if (bytes.starts_with("%PDF")) return "is a PDF, not a mesh: get the file itself";
  return nullptr;
}

std::string extension_of(const std::string& name) {
  return std::filesystem::path(name).extension().string();
}

// Whether the name is of a format that only Assimp reads; such files may be packed on purpose.
bool is_for_assimp(const std::string& name) {
  const std::string extension = extension_of(name);
  return !extension.empty() && assimp_reads(extension) && pick_reader("", extension) == nullptr;
}

void refuse_stranger(Reader reader, std::string_view bytes, const std::string& name) {
  if (reader == read_threemf || looks_like_binary_stl(bytes)) return;
  const char* const what = stranger(bytes);
  if (what != nullptr) bad_file(name, what);
}

bool is_packed(std::string_view bytes, const std::string& name) {
  return packing_of(bytes) != Packing::None && !looks_like_binary_stl(bytes) &&
         !is_for_assimp(name);
}

// `name` stands in messages. UTF-16 is read as what it says.
Mesh read_bytes(Reader reader, std::string_view bytes, const std::string& name) {
  if (reader == nullptr)
    bad_file(name, "is neither PLY, STL, OBJ, OFF nor glTF: convert it to PLY");
  if (reader == read_threemf) return read_threemf(bytes, name);
  const std::optional<std::string> text =
      looks_like_binary_stl(bytes) ? std::nullopt : from_utf16(bytes);
  return read_with(reader, text ? std::string_view(*text) : bytes, name);
}

// What was packed must be of a format that this library reads itself.
Mesh read_packed(std::string_view packed, const std::string& name) {
  const std::string bytes = unpack(packed, name);
  const std::string inner = unpacked_name(name);
  const Reader reader = pick_reader(bytes, extension_of(inner));
  if (reader == nullptr && is_for_assimp(inner)) {
    bad_file(name, "is packed, which a file of this format may not be: unpack it");
  }
  refuse_stranger(reader, bytes, name);
  Mesh mesh = read_bytes(reader, bytes, name);
  mesh.format += packing_of(packed) == Packing::Gzip ? ", gzip" : ", zstd";
  return mesh;
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string name = path.string();
  if (is_packed(file.bytes(), name)) return read_packed(file.bytes(), name);
  const Reader reader = pick_reader(file.bytes(), extension_of(name));
  const bool for_assimp = reader == nullptr && is_for_assimp(name);
  if (!for_assimp) refuse_stranger(reader, file.bytes(), name);
  if (reader != nullptr) return read_bytes(reader, file.bytes(), name);
  if (is_utf32(file.bytes())) bad_file(name, kUtf32);
  const std::optional<std::string> text = for_assimp ? from_utf16(file.bytes()) : std::nullopt;
  return text ? read_by_assimp(path, *text) : read_by_assimp(path);
}

Mesh read_mesh_bytes(std::string_view bytes, const std::string& name) {
  if (is_packed(bytes, name)) return read_packed(bytes, name);
  const Reader reader = pick_reader(bytes, extension_of(name));
  refuse_stranger(reader, bytes, name);
  return read_bytes(reader, bytes, name);
}

}  // namespace pierce::io
