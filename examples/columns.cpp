// SPDX-License-Identifier: Apache-2.0
//
// A lidar scan in columns, as arrays of NumPy, tables and point clouds have them: directions of
// their own, one origin for all, ranges out, and of the triangles their numbers, -1 for none.
// Nothing is copied, and nothing is made into structures on the way.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "pierce/pierce.h"

int main() {
  // A box of 12 triangles around the sensor, open at the top: double vertices in Fortran order (all
  // x, all y, all z), indices as 64-bit integers.
  const std::vector<double> corners = {-2, 2,  2, -2, -2, 2,  2, -2,  //
                                       -1, -1, 3, 3,  -1, -1, 3, 3,   //
                                       0,  0,  0, 0,  1,  1,  1, 1};
  const std::vector<std::int64_t> indices = {0, 1, 2, 0, 2, 3, 0, 5, 1, 0, 4, 5, 1, 6, 2,
                                             1, 5, 6, 2, 7, 3, 2, 6, 7, 3, 4, 0, 3, 7, 4};
  const std::ptrdiff_t column = 8 * sizeof(double);
  pierce::MeshArrays<double> mesh;
  mesh.vertices = {corners.data(), 8, sizeof(double), column};
  mesh.triangles = pierce::Rows<const std::int64_t>{indices.data(), 10, 3 * sizeof(std::int64_t)};
  const auto scene = pierce::Scene<double>::build(mesh);

  // 16 rings of 900 directions, and where the sensor stands.
  std::vector<double> directions;
  for (int ring = 0; ring < 16; ++ring) {
    const double up = 0.03 * (ring - 7.5);
    for (int step = 0; step < 900; ++step) {
      const double angle = step * 2 * 3.14159265358979 / 900;
      for (const double x : {std::cos(angle) * std::cos(up), std::sin(angle) * std::cos(up)}) {
        directions.push_back(x);
      }
      directions.push_back(std::sin(up));
    }
  }
  const std::size_t n = directions.size() / 3;
  const pierce::Vec3<double> sensor = {0, 0, 0.5};
  const double reach = 3.5;
  const pierce::RayArrays<double> rays{
      .origins = pierce::row_for_all(sensor),
      .directions = {directions.data(), n, 3 * sizeof(double)},
      .t_max = pierce::row_for_all(reach),
  };

  std::vector<double> range(n);
  std::vector<std::int64_t> triangle(n);
  scene.closest_hits(rays, pierce::HitArrays<double>{.t = pierce::rows(range),
                                                     .triangle = pierce::rows(triangle)});

  std::size_t hits = 0;
  double nearest = reach;
  for (std::size_t i = 0; i < n; ++i) {
    if ((triangle[i] >= 0) != std::isfinite(range[i])) return 1;
    if (triangle[i] < 0) continue;
    ++hits;
    nearest = std::fmin(nearest, range[i]);
  }
  std::printf("%zu of %zu rays meet something within %g; the nearest at %.3f\n", hits, n, reach,
              nearest);
  return hits > 0 && hits < n && nearest >= 1 && nearest < 1.01 ? 0 : 1;
}
