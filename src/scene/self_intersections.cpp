// SPDX-License-Identifier: Apache-2.0
//
// Pairs of triangles that pass through each other: each triangle's box is looked up in a tree over
// all of them.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/point_traversal.h"
#include "pierce/measure.h"
#include "predicate/settle.h"
#include "predicate/touch.h"
#include "scene/geometries.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"
#include "support/lock.h"

namespace pierce {

template <class Real>
std::vector<TrianglePair> self_intersections(MeshView<Real> mesh, const WorkOptions& work) {
  constexpr std::size_t kTrianglesPerTask = 1024;
  const FloatEnvironment environment;
  const WorkOptions quiet{.threads = work.threads, .stop = work.stop};
  const BuildOptions options{.quality = Quality::Fast, .work = quiet};  // cuts no triangle
  const scene::Geometries<Real> geometries(std::span(&mesh, 1), options);
  const bvh::Tree tree = bvh::build(geometries, options);
  std::vector<std::uint8_t> has_area(geometries.size());
  scene::for_chunks(
      has_area.size(), quiet, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto number = static_cast<std::uint32_t>(i);
          has_area[i] = predicate::settle_has_area(geometries.triangle(number)) ? 1 : 0;
        }
      });
  std::vector<TrianglePair> pairs;
  parallel::Mutex mutex;
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    std::vector<TrianglePair> found;
    predicate::LadderCounts counts;
    scene::StopPoll stop(work.stop);
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      stop.now();
      if (has_area[i] == 0) continue;
      const predicate::TriangleD triangle = geometries.triangle(i);
      const bvh::Corners at = geometries.corners(i);
      const auto ends = [](double a, double b, double c) { return std::minmax({a, b, c}); };
      const auto [low_x, high_x] = ends(at.a.x, at.b.x, at.c.x);
      const auto [low_y, high_y] = ends(at.a.y, at.b.y, at.c.y);
      const auto [low_z, high_z] = ends(at.a.z, at.b.z, at.c.z);
      bvh::traverse_box(tree, {low_x, low_y, low_z}, {high_x, high_y, high_z},
                        [&](std::uint32_t j) {
                          if (j > i && has_area[j] != 0 &&
                              predicate::decide_overlap(triangle, geometries.triangle(j), counts)) {
                            found.push_back({i, j});
                          }
                          stop.sometimes();
                          return false;
                        });
    }
    const parallel::Lock lock(mutex);
    pairs.insert(pairs.end(), found.begin(), found.end());
  };
  scene::for_chunks(has_area.size(), quiet, kTrianglesPerTask, chunk);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template std::vector<TrianglePair> self_intersections(MeshView<float>, const WorkOptions&);
template std::vector<TrianglePair> self_intersections(MeshView<double>, const WorkOptions&);

}  // namespace pierce
