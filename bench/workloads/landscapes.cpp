// SPDX-License-Identifier: Apache-2.0
//
// Meshes out of nothing: a city (large axis-aligned triangles), hills (many even ones) and needles
// (long thin ones, the worst there is for boxes).
#include <cmath>
#include <cstdint>

#include "workloads/generators.h"
#include "workloads/prng.h"

namespace pierce::bench {
namespace {

void add_box(Mesh& mesh, Double3 lower, Double3 upper) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back(
        to_float({(corner & 1U) != 0 ? upper.x : lower.x, (corner & 2U) != 0 ? upper.y : lower.y,
                  (corner & 4U) != 0 ? upper.z : lower.z}));
  }
  // Two triangles a side, counter-clockwise as seen from outside; bits of a corner: x, y, z.
  constexpr std::uint32_t kSides[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                           {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                           {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const auto& side : kSides)
    mesh.triangles.push_back({first + side[0], first + side[1], first + side[2]});
}

// Values of a random lattice with `cells` cells a side, smoothly interpolated and added to the
// heights of a grid of n x n cells.
void add_octave(std::vector<float>& heights, unsigned n, unsigned cells, double amplitude) {
  const std::size_t points = cells + 2;  // one to spare: the last grid line lies on a lattice line
  std::vector<double> lattice(points * points);
  for (std::size_t i = 0; i < lattice.size(); ++i)
    lattice[i] = amplitude * to_unit(mix(i * 0x9e3779b97f4a7c15U + cells));
  std::vector<std::uint32_t> cell(n + 1);
  std::vector<double> weight(n + 1);
  for (unsigned i = 0; i <= n; ++i) {
    const double place = static_cast<double>(i) * cells / n;
    cell[i] = static_cast<std::uint32_t>(place);
    const double f = place - cell[i];
    weight[i] = f * f * (3 - 2 * f);
  }
  std::vector<double> row(points);
  for (unsigned y = 0; y <= n; ++y) {
    const double* below = lattice.data() + cell[y] * points;
    for (std::size_t i = 0; i < points; ++i)
      row[i] = below[i] + weight[y] * (below[i + points] - below[i]);
    float* out = heights.data() + std::size_t{y} * (n + 1);
    for (unsigned x = 0; x <= n; ++x) {
      const double left = row[cell[x]];
      out[x] += static_cast<float>(left + weight[x] * (row[cell[x] + 1] - left));
    }
  }
}

// Hills over a grid of n x n square cells of size 1, two triangles a cell.
Mesh make_hills(unsigned n) {
  std::vector<float> heights(std::size_t{n + 1} * (n + 1));
  double amplitude = 0.15 * n;
  for (unsigned cells = 5; cells <= n / 2; cells *= 2, amplitude *= 0.45)
    add_octave(heights, n, cells, amplitude);
  Mesh mesh;
  mesh.vertices.reserve(heights.size() + 1);
  for (unsigned y = 0; y <= n; ++y)
    for (unsigned x = 0; x <= n; ++x)
      mesh.vertices.push_back(
          {static_cast<float>(x), static_cast<float>(y), heights[std::size_t{y} * (n + 1) + x]});
  mesh.triangles.reserve(std::size_t{n} * n * 2);
  for (unsigned y = 0; y < n; ++y) {
    for (unsigned x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x;
      const std::uint32_t b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  finish(mesh, kLandscape);
  return mesh;
}

}  // namespace

Mesh make_terrain() { return make_hills(2000); }
Mesh make_big_terrain() { return make_hills(5000); }

Mesh make_city() {
  constexpr unsigned kSide = 200;
  constexpr double kPitch = 20;  // metres from house to house
  Mesh mesh;
  mesh.vertices.reserve(kSide * kSide * 8 + 5);
  mesh.triangles.reserve(kSide * kSide * 12 + 2);
  Prng random(0xc17);
  for (unsigned y = 0; y < kSide; ++y) {
    for (unsigned x = 0; x < kSide; ++x) {
      const double half_x = random.between(4, 9);
      const double half_y = random.between(4, 9);
      const double tall = random.unit();
      const double height = 5 + 30 * random.unit() + 150 * tall * tall * tall * tall;
      const Double3 center{(x + 0.5) * kPitch, (y + 0.5) * kPitch, 0};
      add_box(mesh, center - Double3{half_x, half_y, 0}, center + Double3{half_x, half_y, height});
    }
  }
  // The ground lies just below the houses' floors.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const float end = static_cast<float>(kSide * kPitch);
  for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {end, 0.0F}, {end, end}, {0.0F, end}})
    mesh.vertices.push_back({x, y, -0.25F});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  finish(mesh, kLandscape);
  return mesh;
}

Mesh make_needles() {
  constexpr unsigned kCount = 25000;
  constexpr double kLength = 0.08;
  constexpr double kRadius = 0.0008;
  Mesh mesh;
  mesh.vertices.reserve(kCount * 4 + 1);
  mesh.triangles.reserve(kCount * 4);
  Prng random(0x4eed1e);
  for (unsigned i = 0; i < kCount; ++i) {
    const Double3 foot{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const Double3 along = random.on_sphere();
    const Double3 other = random.on_sphere();
    const Double3 side = normalized(cross(along, other) + 1e-3 * other);
    const Double3 third = cross(along, side);
    const auto a = static_cast<std::uint32_t>(mesh.vertices.size());
    const double half = 0.5;
    const double root = std::sqrt(0.75);
    mesh.vertices.push_back(to_float(foot + kRadius * side));
    mesh.vertices.push_back(to_float(foot + kRadius * (root * third - half * side)));
    mesh.vertices.push_back(to_float(foot - kRadius * (root * third + half * side)));
    mesh.vertices.push_back(to_float(foot + (kLength * random.between(0.5, 1.5)) * along));
    mesh.triangles.push_back({a, a + 2, a + 1});
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a + 1, a + 2, a + 3});
    mesh.triangles.push_back({a + 2, a, a + 3});
  }
  finish(mesh, kPortrait);
  return mesh;
}

}  // namespace pierce::bench
