// SPDX-License-Identifier: Apache-2.0
#include "io/write_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "io/bad_file.h"
#include "io/extension.h"
#include "io/npy.h"
#include "io/npz.h"
#include "io/output_file.h"
#include "io/spool_file.h"
#include "pierce/vector.h"

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

namespace {

template <class Real>
void write_obj(const std::filesystem::path& path, MeshView<Real> mesh) {
  OutputFile file(path);
  for (const Vec3<Real>& vertex : mesh.vertices) {
    const Vec3<double> p = convert<double>(vertex);  // readers take text for doubles
    file.write(fmt::format("v {} {} {}\n", p.x, p.y, p.z));
  }
  for (const Triangle& t : mesh.triangles) {
    file.write(fmt::format("f {} {} {}\n", std::uint64_t{t[0]} + 1, std::uint64_t{t[1]} + 1,
                           std::uint64_t{t[2]} + 1));
  }
  file.commit();
}

// The normals are zero, by which readers know to compute them.
template <class Real>
void write_stl(const std::filesystem::path& path, MeshView<Real> mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3<Real>& p = mesh.vertices[i];
    for (const Real x : {p.x, p.y, p.z}) {
      if (static_cast<Real>(static_cast<float>(x)) == x || x != x) continue;
      bad_file(path.string(),
               fmt::format("STL holds floats, and vertex {} has the coordinate {}: write PLY or "
                           "OBJ, or round with --precision float",
                           i, x));
    }
  }
  OutputFile file(path);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::array<char, 84> header = {};
  std::memcpy(header.data() + 80, &count, sizeof count);
  file.write({header.data(), header.size()});
  for (const Triangle& t : mesh.triangles) {
    std::array<char, 50> record = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<float> corner = convert<float>(mesh.vertices[t[k]]);
      std::memcpy(record.data() + 12 * (k + 1), &corner, 12);
    }
    file.write({record.data(), record.size()});
  }
  file.commit();
}

template <class Real>
void write_npz(const std::filesystem::path& path, MeshView<Real> mesh) {
  OutputFile file(path);
  NpzWriter archive(file);
  const auto add = [&]<class Row>(const char* name, const char* type, std::span<const Row> rows) {
    SpoolFile data(file.folder(), path.string());
    constexpr std::size_t kAtOnce = std::size_t{1} << 14;
    for (std::size_t i = 0; i < rows.size(); i += kAtOnce) {
      const std::span<const Row> some = rows.subspan(i, std::min(kAtOnce, rows.size() - i));
      data.write({reinterpret_cast<const char*>(some.data()), some.size_bytes()});
    }
    const std::array<std::uint64_t, 2> shape = {rows.size(), 3};
    archive.add(name, make_npy_header(type, shape), data);
  };
  add("vertices", std::is_same_v<Real, float> ? "'<f4'" : "'<f8'", mesh.vertices);
  add("triangles", "'<u4'", mesh.triangles);
  archive.finish();
  file.commit();
}

}  // namespace

template <class Real>
void write_mesh(const std::filesystem::path& path, MeshView<Real> mesh) {
  if (has_extension(path, ".ply")) return write_ply(path, mesh);
  if (has_extension(path, ".obj")) return write_obj(path, mesh);
  if (has_extension(path, ".stl")) return write_stl(path, mesh);
  if (has_extension(path, ".npz")) return write_npz(path, mesh);
  bad_file(path.string(), "must end in .ply, .obj, .stl or .npz to be written");
}

template void write_mesh(const std::filesystem::path&, MeshView<float>);
template void write_mesh(const std::filesystem::path&, MeshView<double>);
template void write_ply(const std::filesystem::path&, MeshView<float>);
template void write_ply(const std::filesystem::path&, MeshView<double>);

}  // namespace pierce::io
