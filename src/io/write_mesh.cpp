// SPDX-License-Identifier: Apache-2.0
#include "io/write_mesh.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "io/output_file.h"

namespace pierce::io {

static_assert(std::endian::native == std::endian::little, "writes memory as it stands");

template <class Real>
void write_ply(const std::filesystem::path& path, MeshView<Real> mesh) {
  OutputFile file(path);
  const char* const type = std::is_same_v<Real, float> ? "float" : "double";
  file.write(
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
                  "property {} x\nproperty {} y\nproperty {} z\n"
                  "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                  mesh.vertices.size(), type, type, type, mesh.triangles.size()));
  static_assert(sizeof(Vec3<Real>) == 3 * sizeof(Real));
  file.write({reinterpret_cast<const char*>(mesh.vertices.data()), mesh.vertices.size_bytes()});
  for (const Triangle& triangle : mesh.triangles) {
    std::array<char, 1 + sizeof(Triangle)> record = {3};
    std::memcpy(record.data() + 1, triangle.data(), sizeof(Triangle));
    file.write({record.data(), record.size()});
  }
  file.commit();
}

template void write_ply(const std::filesystem::path&, MeshView<float>);
template void write_ply(const std::filesystem::path&, MeshView<double>);

}  // namespace pierce::io
