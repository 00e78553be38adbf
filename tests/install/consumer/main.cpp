// SPDX-License-Identifier: Apache-2.0
//
// A user's program: one ray through the edge that two triangles share, one through a third that is
// farther away, one that misses, in both types, singly and as a batch. Prints hex floats.
#include <pierce/pierce.h>

#include <cstdio>
#include <vector>

namespace {

template <class Real>
void print(const pierce::Hit<Real>& hit) {
  std::printf("t=%a u=%a v=%a w=%a triangle=%d %s\n", static_cast<double>(hit.t),
              static_cast<double>(hit.u), static_cast<double>(hit.v), static_cast<double>(hit.w),
              static_cast<int>(hit.triangle),
              hit.facing == pierce::Facing::Front ? "front" : "back");
}

template <class Real>
void ask() {
  const std::vector<pierce::Vec3<Real>> vertices = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0},
                                                    {5, 0, 1}, {8, 0, 1}, {5, 3, 1}};
  const std::vector<pierce::Triangle> triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  const auto scene = pierce::Scene<Real>::build({vertices, triangles});
  const std::vector<pierce::Ray<Real>> rays = {
      {{1, 1, 7}, {0, 0, -3}}, {{6, 1, -1}, {0, 0, 1}}, {{6, 1, -1}, {0, 0, -1}}};
  std::vector<pierce::Hit<Real>> hits(rays.size());
  scene.closest_hits(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    print(hits[i]);
    const auto single = scene.closest_hit(rays[i]).value_or(pierce::Hit<Real>{});
    std::printf("any=%d single=%s\n", scene.any_hit(rays[i]) ? 1 : 0,
                single == hits[i] ? "same" : "different");
  }
}

}  // namespace

int main() {
  ask<float>();
  ask<double>();
  try {
    const std::vector<pierce::Triangle> triangles = {{0, 1, 2}};
    (void)pierce::Scene<float>::build({{}, triangles});
  } catch (const pierce::Error& error) {
    std::printf("error %s\n", error.code() == pierce::ErrorCode::IndexOutOfRange
                                  ? "index out of range"
                                  : "other");
  }
}
