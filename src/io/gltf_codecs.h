// SPDX-License-Identifier: Apache-2.0
//
// The compressed data that a glTF may hold: Draco meshes and meshopt buffers, by their own
// libraries, which a build may lack.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

[[nodiscard]] bool have_gltf_codecs();

struct DracoAttribute {
  std::uint32_t id = 0;  ///< what the file calls it
  unsigned type = 0;     ///< component type in glTF's numbers, 5120 to 5126; 0: none of them
  unsigned components = 0;
  std::string bytes;  ///< of all points, one after the other
};

struct DracoMesh {
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::uint64_t points = 0;
  std::vector<DracoAttribute> attributes;  ///< those of `ids` that are there
};

/// Returns what is wrong with the bytes, or nothing.
[[nodiscard]] std::string decode_draco(std::string_view bytes, std::span<const std::uint32_t> ids,
                                       DracoMesh& mesh);

enum class MeshoptMode { Attributes, Triangles, Indices };
enum class MeshoptFilter { None, Octahedral, Quaternion, Exponential };

/// `count` items of `stride` bytes each. Returns what is wrong, or nothing.
[[nodiscard]] std::string decode_meshopt(std::string_view bytes, MeshoptMode mode,
                                         MeshoptFilter filter, std::uint64_t count,
                                         std::uint64_t stride, std::string& out);

}  // namespace pierce::io
