// SPDX-License-Identifier: Apache-2.0
//
// Alpha-tested leaves: squares of two triangles whose texture says where there is leaf and where
// there is air. The filter looks the texture up and lets only leaf count.
#include <cstdint>
#include <cstdio>
#include <vector>

#include "pierce/pierce.h"

namespace {

using namespace pierce;

// A round leaf in the square [0, 1]^2.
bool is_leaf(double x, double y) { return (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) <= 0.25; }

// The place of a hit on its square: the triangles are (0,0) (1,0) (1,1) and (0,0) (1,1) (0,1).
bool accepts(std::uint64_t, const Hit<double>& hit) {
  const bool lower = hit.triangle % 2 == 0;
  const double x = lower ? hit.u + hit.v : hit.u;
  const double y = lower ? hit.v : hit.u + hit.v;
  return is_leaf(x, y);
}

}  // namespace

int main() {
  // A hundred leaves one behind the other, and a wall behind them all.
  std::vector<Vec3<float>> vertices;
  std::vector<Triangle> leaves;
  constexpr std::uint32_t kLeaves = 100;
  for (std::uint32_t i = 0; i <= kLeaves; ++i) {
    const auto z = static_cast<float>(i);
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      vertices.push_back({static_cast<float>(x), static_cast<float>(y), z});
    }
    leaves.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    leaves.push_back({4 * i, 4 * i + 2, 4 * i + 3});
  }
  const std::vector<Triangle> wall(leaves.end() - 2, leaves.end());
  leaves.resize(leaves.size() - 2);
  const std::vector<MeshView<float>> meshes = {{vertices, leaves}, {vertices, wall}};
  const auto scene = Scene<float>::build(meshes);
  const HitFilter filter = [](std::uint64_t ray, const Hit<double>& hit) {
    return hit.geometry == 1 || accepts(ray, hit);
  };

  // A camera's rays: each sees the first leaf, or through the corners of all of them the wall.
  constexpr int kSide = 64;
  std::vector<Ray<float>> rays;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto middle = [](int k) { return (static_cast<float>(k) + 0.5F) / kSide; };
    rays.push_back({{middle(i % kSide), middle(i / kSide), -1}, {0, 0, 1}});
  }
  std::vector<Hit<float>> hits(rays.size());
  scene.closest_hits(rays, hits, {.filter = filter});

  int seen = 0;
  bool right = true;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3<float>& from = rays[i].origin;
    const bool leaf = is_leaf(static_cast<double>(from.x), static_cast<double>(from.y));
    seen += leaf ? 1 : 0;
    right = right && hits[i].t == (leaf ? 1.0F : 101.0F) && hits[i].geometry == (leaf ? 0U : 1U);
  }
  std::printf("%d of %zu rays meet a leaf\n", seen, rays.size());
  if (!right) std::puts("that is wrong");
  return right ? 0 : 1;
}
