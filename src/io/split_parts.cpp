// SPDX-License-Identifier: Apache-2.0
#include "io/split_parts.h"

#include <algorithm>
#include <span>
#include <utility>

namespace pierce::io {
namespace {

// The triangles of each part, with the file's vertex numbers.
std::vector<std::vector<Triangle>> triangles_of_parts(const Mesh& mesh) {
  std::vector<std::vector<Triangle>> parts(mesh.part_names.size());
  for (std::size_t i = 0; i < mesh.part_runs.size(); ++i) {
    const PartRun& run = mesh.part_runs[i];
    const std::uint64_t end = i + 1 < mesh.part_runs.size() ? mesh.part_runs[i + 1].first_triangle
                                                            : mesh.triangles.size();
    const auto triangles =
        std::span(mesh.triangles).subspan(run.first_triangle, end - run.first_triangle);
    std::vector<Triangle>& part = parts[run.part];
    part.insert(part.end(), triangles.begin(), triangles.end());
  }
  return parts;
}

// Takes the values of some vertices, if there are values at all.
template <class Value>
std::vector<Value> of_vertices(const std::vector<Value>& values,
                               std::span<const std::uint32_t> vertices) {
  std::vector<Value> taken;
  if (values.empty()) return taken;
  taken.reserve(vertices.size());
  for (const std::uint32_t v : vertices) taken.push_back(values[v]);
  return taken;
}

Mesh take_part(const Mesh& mesh, std::vector<Triangle> triangles) {
  std::vector<std::uint32_t> used;
  used.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) {
      v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    }
  }
  Mesh part;
  part.vertices = of_vertices(mesh.vertices, used);
  part.triangles = std::move(triangles);
  part.normals = of_vertices(mesh.normals, used);
  part.colors = of_vertices(mesh.colors, used);
  part.texcoords = of_vertices(mesh.texcoords, used);
  part.single_precision = mesh.single_precision;
  part.format = mesh.format;
  return part;
}

}  // namespace

std::vector<NamedMesh> split_parts(Mesh mesh) {
  std::vector<NamedMesh> parts;
  if (mesh.part_runs.empty()) {
    parts.push_back({{}, std::move(mesh)});
    return parts;
  }
  std::vector<std::vector<Triangle>> triangles = triangles_of_parts(mesh);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (triangles[i].empty()) continue;
    parts.push_back({mesh.part_names[i], take_part(mesh, std::move(triangles[i]))});
  }
  return parts;
}

}  // namespace pierce::io
