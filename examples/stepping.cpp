// SPDX-License-Identifier: Apache-2.0
//
// How far a ray runs inside solids that lie in one another and touch: from hit to hit by `after`,
// which loses none where walls coincide. Casting again from t would: the other wall is at the same
// t. Two blocks share a wall, and a third one lies in the first.
#include <cstdio>
#include <vector>

#include "pierce/pierce.h"

namespace {

using namespace pierce;

struct Block {
  std::vector<Vec3<double>> vertices;
  std::vector<Triangle> triangles;
};

// The surface of [from, to] x [0, 4] x [0, 4], shrunk by `margin`, facing outward.
Block block(double from, double to, double margin) {
  Block b;
  for (int i = 0; i < 8; ++i) {
    b.vertices.push_back({(i & 1) != 0 ? to : from, (i & 2) != 0 ? 4 - margin : margin,
                          (i & 4) != 0 ? 4 - margin : margin});
  }
  b.triangles = {{0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}};
  return b;
}

}  // namespace

int main() {
  const Block blocks[] = {block(0, 3, 0), block(3, 7, 0), block(1, 2, 1)};
  std::vector<MeshView<double>> meshes;
  for (const Block& b : blocks) meshes.push_back({b.vertices, b.triangles});
  const auto scene = Scene<double>::build(meshes);
  const Ray<double> ray{{-1, 1.75, 2.5}, {1, 0, 0}};  // through no edge

  double inside[3] = {};  // by block
  double entered[3] = {};
  std::vector<Hit<double>> stepped;
  Hit<double> last;  // none yet
  while (const auto hit = scene.closest_hit(ray, {.after = last})) {
    if (hit->facing == Facing::Front) {
      entered[hit->geometry] = hit->t;
    } else {
      inside[hit->geometry] += hit->t - entered[hit->geometry];
    }
    stepped.push_back(last = *hit);
  }
  std::printf("in the blocks: %g, %g, %g\n", inside[0], inside[1], inside[2]);

  std::vector<Hit<double>> all;
  scene.all_hits(ray, all);
  const bool right = stepped == all && inside[0] == 3 && inside[1] == 4 && inside[2] == 1 &&
                     scene.count_hits(ray, {.distinct = true}) == all.size() - 1;
  if (!right) std::puts("that is wrong");
  return right ? 0 : 1;
}
