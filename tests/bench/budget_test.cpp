// SPDX-License-Identifier: Apache-2.0
//
// How rarely ordinary rays need more than float and double: a budget, so that a filter that grows
// timid is noticed although every answer stays right.
#include <gtest/gtest.h>

#include <vector>

#include "pierce/scene.h"
#include "workloads/rays.h"

namespace pierce::bench {
namespace {

Statistics statistics_of(const Scene<float>& scene, const std::vector<Ray<float>>& rays) {
  Statistics statistics;
  BatchOptions options;
  options.work.statistics = &statistics;
  std::vector<Hit<float>> hits(rays.size());
  scene.closest_hits(rays, hits, options);
  return statistics;
}

Statistics statistics_of_all(const Scene<float>& scene, const std::vector<Ray<float>>& rays) {
  Statistics statistics;
  BatchOptions options;
  options.work.statistics = &statistics;
  (void)scene.all_hits(rays, options);
  return statistics;
}

TEST(Budget, of_ordinary_candidates_fewer_than_one_in_100000_are_unsure_after_the_double_rung) {
  const Mesh mesh = make_mesh("bunny");
  const auto scene = Scene<float>::build(mesh.mesh_view());
  RayMaker maker(
      mesh,
      [&](std::span<const Ray<float>> rays, std::span<Hit<float>> hits) {
        scene.closest_hits(rays, hits);
      },
      512);
  for (const char* set : {"primary", "shadow", "bounce", "random"}) {
    const auto rays = maker.make(set).rays;
    const Statistics s = statistics_of(scene, rays);
    EXPECT_GT(s.candidates, s.rays / 20) << set;
    EXPECT_LT((s.settled + s.settled_big + s.orders_settled) * 100000, s.candidates) << set;
    EXPECT_LT(s.certified * 10, s.candidates) << set;   // float tells nine of ten
    EXPECT_LT(s.rounded_exactly * 100, s.hits) << set;  // lanes round nearly all
    // The same of all hits.
    const Statistics all = statistics_of_all(scene, rays);
    EXPECT_LT(all.certified * 10, all.candidates) << set;
    EXPECT_LT((all.settled + all.settled_big + all.orders_settled) * 100000, all.candidates) << set;
  }
}

}  // namespace
}  // namespace pierce::bench
