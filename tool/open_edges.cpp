// SPDX-License-Identifier: Apache-2.0
#include "open_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <type_traits>

#include "io/extension.h"
#include "io/output_file.h"

namespace pierce::tool {
namespace {

template <class Real>
using Position = std::tuple<Real, Real, Real>;

template <class Real>
Position<Real> position(const Vec3<Real>& p) {
  return {p.x + 0, p.y + 0, p.z + 0};  // -0 is 0
}

// Equal positions, equal numbers. Vertices that no triangle uses may be anything, also NaN, which
// has no place in an order.
template <class Real>
std::vector<std::uint32_t> numbers_by_position(std::span<const Vec3<Real>> vertices) {
  std::vector<std::uint32_t> order, number(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const Vec3<Real>& p = vertices[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return position(vertices[a]) < position(vertices[b]);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && position(vertices[order[i]]) == position(vertices[order[i - 1]]);
    number[order[i]] = same ? number[order[i - 1]] : static_cast<std::uint32_t>(i);
  }
  return number;
}

// One use of an edge; those of one edge are neighbours once sorted, the first use first.
struct Use {
  std::uint32_t low, high;  // by position
  std::uint32_t triangle;
  std::uint32_t corner;  // where in the triangle the edge starts
  bool upward;

  friend bool operator<(const Use& a, const Use& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) <
           std::tie(b.low, b.high, b.triangle, b.corner);
  }
  [[nodiscard]] bool same_edge(const Use& other) const {
    return low == other.low && high == other.high;
  }
};

// A triangle of which two corners are one vertex has nothing to close.
template <class Real>
std::vector<Use> uses_of_edges(MeshView<Real> mesh) {
  const std::vector<std::uint32_t> number = numbers_by_position(mesh.vertices);
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Triangle n = {number[t[0]], number[t[1]], number[t[2]]};
    if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(n[k], n[(k + 1) % 3]);
      uses.push_back({low, high, i, k, n[k] == low});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

template <class Real>
std::string coordinates(const Vec3<Real>& p) {
  return fmt::format("{},{},{}", p.x, p.y, p.z);
}

template <class Real>
void write_csv(io::OutputFile& file, const OneMesh<Real>& meshes, const std::vector<EdgeUse>& edges,
               std::span<const double> widths) {
  const auto vertices = meshes.view().vertices;
  file.write(std::string(kOpenEdgeColumns) + "\n");
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EdgeUse& edge = edges[i];
    const auto [geometry, triangle] = meshes.ref(edge.triangle);
    file.write(fmt::format("{},{},{},{},{},{},{},{},{}\n", geometry, triangle,
                           meshes.vertex(geometry, edge.from), meshes.vertex(geometry, edge.to),
                           edge.forward, edge.backward, coordinates(vertices[edge.from]),
                           coordinates(vertices[edge.to]), widths[i]));
  }
}

template <class Number>
void put(std::string& bytes, Number number) {
  std::array<char, sizeof number> raw;
  std::memcpy(raw.data(), &number, sizeof number);
  bytes.append(raw.data(), raw.size());
}

template <class Real>
void write_ply(io::OutputFile& file, const OneMesh<Real>& meshes,
               const std::vector<EdgeUse>& edges) {
  const auto vertices = meshes.view().vertices;
  std::map<Position<Real>, std::uint32_t> numbers;
  std::string points, lines;
  const auto number = [&](std::uint32_t vertex) {
    const Vec3<Real>& p = vertices[vertex];
    const auto [found, is_new] =
        numbers.try_emplace(position(p), static_cast<std::uint32_t>(numbers.size()));
    for (const Real x : {p.x, p.y, p.z}) {
      if (is_new) put(points, x);
    }
    return found->second;
  };
  for (const EdgeUse& edge : edges) {
    put(lines, number(edge.from));
    put(lines, number(edge.to));
  }
  const char* const type = std::is_same_v<Real, float> ? "float" : "double";
  file.write(
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
                  "property {} x\nproperty {} y\nproperty {} z\nelement edge {}\n"
                  "property uint vertex1\nproperty uint vertex2\nend_header\n",
                  numbers.size(), type, type, type, edges.size()));
  file.write(points);
  file.write(lines);
}

}  // namespace

template <class Real>
std::vector<EdgeUse> open_edges(MeshView<Real> mesh) {
  const std::vector<Use> uses = uses_of_edges(mesh);
  std::vector<std::pair<Use, EdgeUse>> found;
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    const Use& first = uses[i];
    std::uint64_t forward = 0;
    for (end = i; end < uses.size() && uses[end].same_edge(first); ++end) {
      forward += uses[end].upward == first.upward ? 1 : 0;
    }
    const std::uint64_t backward = end - i - forward;
    if (forward == backward) continue;
    const Triangle& t = mesh.triangles[first.triangle];
    found.push_back({first,
                     {first.triangle, t[first.corner], t[(first.corner + 1) % 3],
                      end - i > 1 ? uses[i + 1].triangle : kNone, forward, backward}});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.triangle, a.first.corner) < std::tie(b.first.triangle, b.first.corner);
  });
  std::vector<EdgeUse> edges;
  for (const auto& [use, edge] : found) edges.push_back(edge);
  return edges;
}

template <class Real>
void write_open_edges(const std::filesystem::path& path, const OneMesh<Real>& meshes,
                      const std::vector<EdgeUse>& edges, std::span<const double> widths) {
  io::OutputFile file(path);
  if (io::has_extension(path, ".ply")) {
    write_ply(file, meshes, edges);
  } else {
    write_csv(file, meshes, edges, widths);
  }
  file.commit();
}

template std::vector<EdgeUse> open_edges(MeshView<float>);
template std::vector<EdgeUse> open_edges(MeshView<double>);
template void write_open_edges(const std::filesystem::path&, const OneMesh<float>&,
                               const std::vector<EdgeUse>&, std::span<const double>);
template void write_open_edges(const std::filesystem::path&, const OneMesh<double>&,
                               const std::vector<EdgeUse>&, std::span<const double>);

}  // namespace pierce::tool
