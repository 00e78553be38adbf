// SPDX-License-Identifier: Apache-2.0
//
// Any bytes under any name: our mesh readers give a mesh whose indices are all valid, or throw
// Error with one line; they never take much more memory than the file, or 64 MiB if it is packed.
// Assimp is left out: on broken files it has faults of its own, which are not ours to mend.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include "io/read_mesh.h"
#include "io/split_parts.h"
#include "pierce/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const pierce::io::Mesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  for (const pierce::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) require(corner < vertices);
  }
  require(mesh.normals.empty() || mesh.normals.size() == vertices);
  require(mesh.colors.empty() || mesh.colors.size() == vertices);
  require(mesh.texcoords.empty() || mesh.texcoords.size() == vertices);
}

// Every triangle belongs to one part.
void check_parts(const pierce::io::Mesh& mesh) {
  std::size_t triangles = 0;
  for (const pierce::io::NamedMesh& part : pierce::io::split_parts(mesh)) {
    check(part.mesh);
    triangles += part.mesh.triangles.size();
  }
  require(triangles == mesh.triangles.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // The first byte picks the name, so that every reader sees bytes that deny it.
  static constexpr const char* kNames[] = {"m",     "m.ply",  "m.stl", "m.obj",
                                           "m.off", "m.gltf", "m.glb", "m.3mf"};
  const char* const name = kNames[data[0] % std::size(kNames)];
  try {
    const pierce::io::Mesh mesh =
        pierce::io::read_mesh_bytes({reinterpret_cast<const char*>(data) + 1, size - 1}, name);
    check(mesh);
    check_parts(mesh);
  } catch (const pierce::Error& error) {
    require(error.code() == pierce::ErrorCode::BadFile);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
