// SPDX-License-Identifier: Apache-2.0
//
// Any bytes under any name: our mesh readers give a mesh whose indices are all valid, or throw
// Error with one line; they never take much more memory than the file, or 64 MiB if it is packed.
// Bytes may also be the model in a 3MF, whose archive is made here: few changes of packed bytes
// give another text. Assimp is left out: on broken files it has faults of its own, which are not
// ours to mend.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include "io/npz.h"
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

template <class... Numbers>
std::string words(Numbers... numbers) {  // 16 bits each
  std::string bytes;
  (bytes.append({static_cast<char>(numbers & 0xff), static_cast<char>(numbers >> 8 & 0xff)}), ...);
  return bytes;
}

std::string double_words(std::size_t number) { return words(number, number >> 16); }

// An archive whose one member is not packed.
std::string threemf_of(std::string_view model) {
  const std::string member = "3D/3dmodel.model", size = double_words(model.size());
  const std::string about = words(20, 0, 0, 0, 33) + double_words(pierce::io::crc32(0, model)) +
                            size + size + words(member.size(), 0);
  const std::string head = "PK\x03\x04" + about + member;
  const std::string entry = "PK\x01\x02" + words(20) + about + words(0, 0, 0, 0, 0, 0, 0) + member;
  return head + std::string(model) + entry + "PK\x05\x06" + words(0, 0, 1, 1) +
         double_words(entry.size()) + double_words(head.size() + model.size()) + words(0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // The first byte picks the name, so that every reader sees bytes that deny it.
  static constexpr const char* kNames[] = {"m",     "m.ply",  "m.stl", "m.obj",
                                           "m.off", "m.gltf", "m.glb", "m.3mf"};
  const std::size_t pick = data[0] % (std::size(kNames) + 1);
  const bool is_model = pick == std::size(kNames);
  const char* const name = is_model ? "m.3mf" : kNames[pick];
  std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::string archive;
  if (is_model) bytes = archive = threemf_of(bytes);
  try {
    const pierce::io::Mesh mesh = pierce::io::read_mesh_bytes(bytes, name);
    check(mesh);
    check_parts(mesh);
  } catch (const pierce::Error& error) {
    require(error.code() == pierce::ErrorCode::BadFile);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
