// SPDX-License-Identifier: Apache-2.0
#include "io/gltf_primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "io/bad_file.h"
#include "io/mesh_parts.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

constexpr std::uint64_t kTriangles = 4, kFan = 6;

class PrimitiveReader {
 public:
  PrimitiveReader(GltfFile& file, const JsonView& primitive) : file_(file), json_(primitive) {}

  std::optional<GltfPrimitive> read() {
    const std::uint64_t mode = json_.whole("mode", kTriangles);
    if (mode > kFan) json_.at("mode").fail(fmt::format("{} is no mode: correct it", mode));
    if (mode < kTriangles) return std::nullopt;
    const JsonView attributes = json_.at("attributes");
    const std::optional<JsonView> position = attributes.find("POSITION");
    if (!position) {
      warn(json_, "has no positions and is left out");
      return std::nullopt;
    }
    if (const std::optional<JsonView> extension = draco()) read_draco(*extension);
    GltfPrimitive out;
    out.positions = numbers(attributes, "POSITION", 3);
    if (out.positions.count > kMaxVertices) json_.fail("more than 2^32 - 1 vertices: split it");
    out.triangles = make_triangles(is_draco_ ? kTriangles : mode, read_indices(out.positions.count),
                                   out.positions.count);
    read_attributes(attributes, out);
    return out;
  }

 private:
  // The compressed data, unless the file has the same uncompressed, which has lost nothing.
  [[nodiscard]] std::optional<JsonView> draco() const {
    const std::optional<JsonView> extensions = json_.find("extensions");
    if (!extensions) return std::nullopt;
    std::optional<JsonView> found = extensions->find("KHR_draco_mesh_compression");
    const bool plain = file_.has_data(json_.at("attributes").at("POSITION")) &&
                       (!json_.has("indices") || file_.has_data(json_.at("indices")));
    return plain ? std::nullopt : found;
  }

  void read_draco(const JsonView& extension) {
    const JsonView attributes = extension.at("attributes");
    if (!attributes.json().is_object()) attributes.fail("expected an object: correct it");
    std::vector<std::uint32_t> ids;
    for (const auto& [key, value] : attributes.json().items()) {
      ids.push_back(static_cast<std::uint32_t>(attributes.at(key.c_str()).whole(0xffffffff)));
      draco_ids_.emplace_back(key, ids.back());
    }
    const std::string_view bytes = file_.view_bytes(extension.at("bufferView"));
    const std::string trouble = decode_draco(bytes, ids, draco_);
    if (!trouble.empty()) {
      extension.fail(fmt::format("cannot be decoded ({}): get the file again", trouble));
    }
    is_draco_ = true;
  }

  GltfNumbers numbers(const JsonView& attributes, const char* key, unsigned components) {
    const JsonView index = attributes.at(key);
    if (!is_draco_) return file_.numbers(index, components);
    for (const auto& [name, id] : draco_ids_) {
      if (name != key) continue;
      for (const DracoAttribute& attribute : draco_.attributes) {
        if (attribute.id == id) return file_.numbers(index, components, attribute);
      }
    }
    index.fail("is not among the Draco data: the file was damaged");
  }

  std::vector<std::uint32_t> read_indices(std::uint64_t vertices) {
    if (is_draco_) return std::move(draco_.indices);
    if (const std::optional<JsonView> index = json_.find("indices")) return file_.indices(*index);
    std::vector<std::uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }

  std::vector<Triangle> make_triangles(std::uint64_t mode,
                                       const std::vector<std::uint32_t>& corners,
                                       std::uint64_t vertices) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] < vertices) continue;
      json_.fail(fmt::format("index {} names vertex {}, {}: correct it", i, corners[i],
                             there_are(vertices)),
                 i);
    }
    std::vector<Triangle> triangles;
    if (mode == kTriangles) {
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
      }
      if (corners.size() % 3 != 0) {
        warn(json_, fmt::format("{} behind the last whole triangle left out",
                                counted(corners.size() % 3, "corner", "corners")));
      }
      return triangles;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
      const std::size_t odd = i % 2;
      triangles.push_back(mode == kFan
                              ? Triangle{corners[i + 1], corners[i + 2], corners[0]}
                              : Triangle{corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
    }
    return triangles;
  }

  // For pictures only: what is wrong with them leaves the triangles as they are.
  void read_attributes(const JsonView& attributes, GltfPrimitive& out) {
    const auto row = [](const GltfNumbers& n, std::uint64_t i, std::uint64_t k) {
      return nearest_float(n.numbers[n.numbers.size() / n.count * i + k]);
    };
    const std::uint64_t count = out.positions.count;
    if (const GltfNumbers n = attribute(attributes, "NORMAL", {3}, count); n.count > 0) {
      for (std::uint64_t i = 0; i < count; ++i) {
        out.normals.push_back({row(n, i, 0), row(n, i, 1), row(n, i, 2)});
      }
    }
    if (const GltfNumbers n = attribute(attributes, "COLOR_0", {3, 4}, count); n.count > 0) {
      for (std::uint64_t i = 0; i < count; ++i) {
        out.colors.push_back({row(n, i, 0), row(n, i, 1), row(n, i, 2)});
      }
    }
    if (const GltfNumbers n = attribute(attributes, "TEXCOORD_0", {2}, count); n.count > 0) {
      for (std::uint64_t i = 0; i < count; ++i) {
        out.texcoords.push_back({row(n, i, 0), row(n, i, 1)});
      }
    }
  }

  // One of the numbers of components must fit.
  GltfNumbers attribute(const JsonView& attributes, const char* key,
                        std::initializer_list<unsigned> components, std::uint64_t count) {
    if (!attributes.has(key)) return {};
    std::string trouble;
    for (const unsigned wide : components) {
      try {
        GltfNumbers found = numbers(attributes, key, wide);
        if (found.count == count) return found;
        trouble = fmt::format("{} values for {} vertices", found.count, count);
      } catch (const Error& error) {
        trouble = error.what();
      }
    }
    warn(attributes, fmt::format("{} is left out ({})", key, trouble));
    return {};
  }

  void warn(const JsonView& where, const std::string& line) {
    file_.warnings.push_back(fmt::format("{}: {}", where.where(), line));
  }

  GltfFile& file_;
  const JsonView& json_;
  DracoMesh draco_;
  std::vector<std::pair<std::string, std::uint32_t>> draco_ids_;
  bool is_draco_ = false;
};

}  // namespace

std::optional<GltfPrimitive> read_gltf_primitive(GltfFile& file, const JsonView& primitive) {
  return PrimitiveReader(file, primitive).read();
}

}  // namespace pierce::io
