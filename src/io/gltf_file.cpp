// SPDX-License-Identifier: Apache-2.0
#include "io/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "io/bad_file.h"
#include "io/base64.h"

namespace pierce::io {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return value;
}

// Extensions that say nothing of where the triangles are.
bool is_about_others(std::string_view extension) {
  constexpr std::string_view kPrefixes[] = {"KHR_technique",         "KHR_materials_",
                                            "EXT_materials_",        "KHR_texture_",
                                            "EXT_texture_",          "KHR_lights_",
                                            "EXT_lights_",           "KHR_xmp",
                                            "MSFT_texture_dds",      "MSFT_packing_",
                                            "ADOBE_materials_",      "GOOGLE_texture_",
                                            "KHR_animation_",        "KHR_audio",
                                            "KHR_interactivity",     "KHR_physics_",
                                            "OMI_physics_",          "EXT_mesh_features",
                                            "EXT_instance_features", "EXT_structural_metadata",
                                            "EXT_feature_metadata",  "CESIUM_primitive_outline",
                                            "MOZ_hubs_components",   "VRM"};
  return std::any_of(std::begin(kPrefixes), std::end(kPrefixes),
                     [&](std::string_view prefix) { return extension.starts_with(prefix); });
}

bool needs_codecs(std::string_view extension) {
  return extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression";
}

bool is_known(std::string_view extension) {
  return extension == "KHR_mesh_quantization" || extension == "EXT_mesh_gpu_instancing" ||
         needs_codecs(extension) || is_about_others(extension);
}

// "%20" and the like.
std::string unescaped(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c + 32) : c;
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string out(text.substr(0, text.find('%')));
  for (std::size_t i = out.size(); i < text.size(); ++i) {
    const bool escape =
        text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    if (!escape) {
      out += text[i];
      continue;
    }
    out += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
    i += 2;
  }
  return out;
}

// Also if "%20" is in the file's own name, or a program of Windows wrote backslashes.
std::filesystem::path named_file(const std::filesystem::path& folder, std::string_view uri) {
  const std::string plain = unescaped(uri);
  std::string slashes = plain;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code ignored;
  for (const std::string& name : {plain, std::string(uri), slashes}) {
    if (std::filesystem::exists(folder / name, ignored)) return folder / name;
  }
  return folder / plain;
}

}  // namespace

GltfFile::GltfFile(std::string_view bytes, const std::string& name) : name_(name) {
  read_container(bytes);
  if (!json_.is_object()) bad_file(name, "is no glTF: a glTF is one JSON object");
  const std::optional<JsonView> asset = document().find("asset");
  if (!asset) bad_file(name, "is no glTF 2.0, which has an 'asset': convert it to glTF 2.0");
  const nlohmann::json& stated = asset->at("version").json();
  const std::string version = stated.is_string()       ? stated.get<std::string>()
                              : stated.is_structured() ? stated.type_name()
                                                       : stated.dump();
  if (!version.starts_with("2.")) {
    asset->fail(
        fmt::format("version {}: only glTF 2 is read, convert the file", in_quotes(version)));
  }
  check_extensions();
}

// .glb: a header, a chunk of JSON, perhaps one of data, perhaps others.
void GltfFile::read_container(std::string_view bytes) {
  is_binary_ = bytes.starts_with(kMagic);
  if (!is_binary_) {
    json_ = parse_json(bytes, name_);
    return;
  }
  if (bytes.size() < 20)
    bad_byte(name_, bytes.size(), "the file ends in its header: it was cut off");
  const std::uint32_t version = word_at(bytes, 4), length = word_at(bytes, 8);
  if (version != 2) {
    bad_byte(name_, 4,
             fmt::format("binary glTF of version {}: only 2 is read, convert the file", version));
  }
  if (length < 20) {
    bad_byte(name_, 8,
             fmt::format("the header announces {} bytes, less than its own: get it again", length));
  }
  if (length > bytes.size()) {
    bad_byte(name_, 8,
             fmt::format("the header announces {} bytes, the file has {}: it was cut off", length,
                         bytes.size()));
  }
  if (length < bytes.size()) {
    warnings.push_back(fmt::format("{} bytes behind the announced {} are left out",
                                   bytes.size() - length, length));
  }
  bytes = bytes.substr(0, length);
  bool first = true;
  for (std::size_t at = 12; bytes.size() >= 8 && at <= bytes.size() - 8; first = false) {
    const std::uint32_t size = word_at(bytes, at), kind = word_at(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at) {
      bad_byte(name_, at,
               fmt::format("a chunk of {} bytes ends behind the {} that the header announces: the "
                           "file was cut off or damaged, get it again",
                           size, length));
    }
    const std::string_view chunk = bytes.substr(at, size);
    if (first && kind != kJsonChunk) bad_byte(name_, at, "the first chunk is not JSON: damaged");
    if (first) json_ = parse_json(chunk.substr(0, chunk.find_last_not_of('\0') + 1), name_);
    if (kind == kBinaryChunk && !has_chunk_) {
      chunk_ = chunk;
      has_chunk_ = true;
    }
    at += std::min<std::size_t>(size + (4 - size % 4) % 4, bytes.size() - at);
  }
}

void GltfFile::check_extensions() const {
  const std::optional<JsonView> required = document().find("extensionsRequired");
  for (std::uint64_t i = 0; required && i < required->size(); ++i) {
    const JsonView item = required->at(i);
    const std::string& extension = item.text();
    if (!is_known(extension)) {
      item.fail(
          fmt::format("the file cannot be read without the extension {}, which pierce does "
                      "not know: save it without",
                      in_quotes(extension)));
    }
    if (needs_codecs(extension) && !have_gltf_codecs()) {
      item.fail(
          fmt::format("this pierce was built without the decoder of {}: save the file "
                      "without it, or build pierce with PIERCE_INSTALLED_LIBRARIES=ON",
                      extension));
    }
  }
}

std::string_view GltfFile::buffer(const JsonView& index) {
  const JsonView found = document().named("buffers", index);
  const std::uint64_t number = index.whole();
  const auto known = buffers_.find(number);
  if (known != buffers_.end()) return known->second;
  const std::string_view bytes = load_buffer(found, number);
  const std::uint64_t length = found.at("byteLength").whole();
  if (length > bytes.size()) {
    found.fail(fmt::format("{} bytes are announced, there are {}: the file was cut off", length,
                           bytes.size()));
  }
  return buffers_[number] = bytes.substr(0, length);
}

std::string_view GltfFile::load_buffer(const JsonView& buffer, std::uint64_t index) {
  const std::optional<JsonView> uri = buffer.find("uri");
  if (!uri) {
    if (index == 0 && has_chunk_) return chunk_;
    buffer.fail("has neither a uri nor data in this file: it is not complete");
  }
  const std::string_view text = uri->text();
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    if (comma == text.npos) uri->fail("data without a comma before them: the file was damaged");
    std::string data = unescaped(text.substr(comma + 1));
    if (!text.substr(0, comma).ends_with(";base64")) {
      return decoded_buffers_[index] = std::move(data);
    }
    std::optional<std::string> bytes = decode_base64(data);
    if (!bytes) uri->fail("is no base64: the file was damaged");
    return decoded_buffers_[index] = *std::move(bytes);
  }
  if (text.find("://") != text.npos) {
    uri->fail(
        fmt::format("{} is an address: download the file, and name it as it lies beside this "
                    "one",
                    in_quotes(text)));
  }
  const std::filesystem::path folder = std::filesystem::path(name_).parent_path();
  try {
    files_.push_back(std::make_unique<MappedFile>(named_file(folder, text)));
  } catch (const Error& error) {
    uri->fail(fmt::format("{}; a glTF needs all its files", error.what()));
  }
  return files_.back()->bytes();
}

std::string_view GltfFile::view_bytes(const JsonView& index) { return view(index).bytes; }

GltfFile::View GltfFile::view(const JsonView& index) {
  const JsonView found = document().named("bufferViews", index);
  const std::optional<JsonView> extensions = found.find("extensions");
  if (extensions && extensions->has("EXT_meshopt_compression") && have_gltf_codecs()) {
    return decoded_view(extensions->at("EXT_meshopt_compression"), index.whole());
  }
  const std::string_view bytes = buffer(found.at("buffer"));
  const std::uint64_t offset = found.whole("byteOffset", 0),
                      length = found.at("byteLength").whole();
  if (offset > bytes.size() || length > bytes.size() - offset) {
    found.fail(fmt::format("bytes {} to {} are not in the buffer, which has {}: correct it", offset,
                           offset + length, bytes.size()));
  }
  return {bytes.substr(offset, length), found.whole("byteStride", 0)};
}

GltfFile::View GltfFile::decoded_view(const JsonView& extension, std::uint64_t index) {
  const std::uint64_t stride = extension.at("byteStride").whole(256);
  const auto known = decoded_views_.find(index);
  if (known != decoded_views_.end()) return {known->second, stride};
  const std::string_view bytes = buffer(extension.at("buffer"));
  const std::uint64_t offset = extension.whole("byteOffset", 0);
  const std::uint64_t length = extension.at("byteLength").whole();
  if (offset > bytes.size() || length > bytes.size() - offset) {
    extension.fail("its bytes are not in the buffer: correct it");
  }
  const auto choose = [&](const char* key, const auto& names, const std::string& otherwise) {
    const std::string name = extension.has(key) ? extension.at(key).text() : otherwise;
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
      extension.at(key).fail(
          fmt::format("{} is not known: save the file otherwise", in_quotes(name)));
    }
    return at - names.begin();
  };
  constexpr std::array<std::string_view, 3> kModes = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::array<std::string_view, 4> kFilters = {"NONE", "OCTAHEDRAL", "QUATERNION",
                                                        "EXPONENTIAL"};
  if (stride == 0) extension.fail("a byteStride of 0 cannot be: correct it");
  std::string out;
  const std::string trouble = decode_meshopt(
      bytes.substr(offset, length), static_cast<MeshoptMode>(choose("mode", kModes, "")),
      static_cast<MeshoptFilter>(choose("filter", kFilters, "NONE")), extension.at("count").whole(),
      stride, out);
  if (!trouble.empty()) {
    extension.fail(fmt::format("cannot be decoded ({}): get the file again", trouble));
  }
  return {decoded_views_[index] = std::move(out), stride};
}

}  // namespace pierce::io
