// SPDX-License-Identifier: Apache-2.0
//
// The bunny, and what is made by dividing triangles: the fine bunny, the icosphere.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "workloads/generators.h"
#include "workloads/prng.h"

namespace pierce::bench {
namespace {

constexpr const char* kBunnyFile = "/usr/share/glmark2/models/bunny.obj";

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

// Every edge once, sorted; the place of an edge gives the number of its new vertex.
std::vector<std::uint64_t> unique_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::uint64_t> edges;
  edges.reserve(triangles.size() * 3);
  for (const auto& [a, b, c] : triangles) {
    edges.push_back(edge_key(a, b));
    edges.push_back(edge_key(b, c));
    edges.push_back(edge_key(c, a));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

Vec3<float> jittered_midpoint(const Vec3<float>& a, const Vec3<float>& b, std::uint64_t key,
                              double jitter) {
  const Double3 from = to_double(a);
  const Double3 to = to_double(b);
  Prng random(key);
  const double reach = jitter * length(to - from);
  const Double3 shift{random.between(-reach, reach), random.between(-reach, reach),
                      random.between(-reach, reach)};
  return to_float(0.5 * (from + to) + shift);
}

}  // namespace

void subdivide(std::vector<Vec3<float>>& vertices, std::vector<Triangle>& triangles,
               double jitter) {
  const std::vector<std::uint64_t> edges = unique_edges(triangles);
  const std::size_t old_count = vertices.size();
  vertices.reserve(old_count + edges.size() + 1);
  for (const std::uint64_t key : edges) {
    vertices.push_back(
        jittered_midpoint(vertices[key >> 32], vertices[key & 0xffffffffU], key, jitter));
  }
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto place = std::lower_bound(edges.begin(), edges.end(), edge_key(a, b));
    return static_cast<std::uint32_t>(old_count + static_cast<std::size_t>(place - edges.begin()));
  };
  std::vector<Triangle> divided;
  divided.reserve(triangles.size() * 4);
  for (const auto& [a, b, c] : triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    divided.insert(divided.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  triangles = std::move(divided);
}

Mesh make_bunny() {
  Mesh mesh = load_mesh(kBunnyFile);
  mesh.name = "bunny";
  return mesh;
}

Mesh make_fine_bunny() {
  Mesh mesh = make_bunny();
  mesh.name = "bunny-fine";
  for (int level = 0; level < 2; ++level) subdivide(mesh.vertices, mesh.triangles, 0.05);
  finish(mesh, kPortrait);
  return mesh;
}

Mesh make_icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;  // the golden ratio
  Mesh mesh;
  mesh.name = "icosphere";
  for (const Double3 p : {Double3{-1, g, 0},
                          {1, g, 0},
                          {-1, -g, 0},
                          {1, -g, 0},
                          {0, -1, g},
                          {0, 1, g},
                          {0, -1, -g},
                          {0, 1, -g},
                          {g, 0, -1},
                          {g, 0, 1},
                          {-g, 0, -1},
                          {-g, 0, 1}})
    mesh.vertices.push_back(to_float(normalized(p)));
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    subdivide(mesh.vertices, mesh.triangles, 0);
    for (Vec3<float>& p : mesh.vertices) p = to_float(normalized(to_double(p)));
  }
  finish(mesh, kPortrait);
  return mesh;
}

}  // namespace pierce::bench
