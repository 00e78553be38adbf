// SPDX-License-Identifier: Apache-2.0
//
// From inside a closed mesh there is no way out: no ray through any vertex or the midpoint of any
// edge is a miss. This is where inexact ray casters leak.
#include <gtest/gtest.h>

#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/compare_scene.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

template <class Real>
class Watertight : public testing::Test {
 public:
  /// Rays from each point through every vertex and edge midpoint, and the other way.
  static std::vector<Ray<Real>> rays_outward(const hard::Mesh<Real>& mesh,
                                             const std::vector<Vec3<Real>>& inside) {
    std::vector<Ray<Real>> rays;
    const auto targets = hard::vertices_and_midpoints(mesh);
    for (const auto& o : inside) {
      for (const auto& p : targets) {
        const Vec3<Real> d{p.x - o.x, p.y - o.y, p.z - o.z};
        if (d == Vec3<Real>{0, 0, 0}) continue;
        rays.push_back({o, d});
        rays.push_back({o, {-d.x, -d.y, -d.z}});
      }
    }
    return rays;
  }

  static void expect_no_leak(const std::string& name, const hard::Mesh<Real>& mesh,
                             std::size_t origins, std::size_t checked_by_oracle,
                             Quality quality = Quality::Balanced) {
    hard::Rng rng(hard::seed(), 3);
    const auto inside = hard::points_inside(rng, mesh, origins);
    const auto rays = rays_outward(mesh, inside);
    const auto scene = Scene<Real>::build(mesh.view(), {.quality = quality});
    std::vector<Hit<Real>> hits(rays.size());
    std::vector<std::uint8_t> any(rays.size());
    scene.closest_hits(rays, hits);
    scene.any_hits(rays, any);
    std::size_t misses = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool miss = hits[i].triangle == kNone || any[i] == 0 || !scene.any_hit(rays[i]);
      misses += miss ? 1 : 0;
      if (miss && misses == 1) ADD_FAILURE() << name << " leaks: " << show::text(rays[i]);
    }
    EXPECT_EQ(misses, 0u) << name << ", of " << rays.size() << " rays";
    const oracle::BruteForce<Real> truth(mesh.view());
    for (std::size_t i = 0; i < checked_by_oracle; ++i) {
      const auto& ray = rays[rng.below(rays.size())];
      const auto found = oracle::difference_on_one_ray(scene, truth, ray);
      ASSERT_FALSE(found) << name << " " << show::text(ray) << *found;
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Watertight, Reals);

TYPED_TEST(Watertight, small_closed_meshes_have_no_leak_at_any_vertex_or_edge) {
  for (const auto& [name, mesh] : hard::small_closed_meshes<TypeParam>()) {
    this->expect_no_leak(name, mesh, 6, 60);
  }
}

TYPED_TEST(Watertight, no_quality_leaks) {
  for (const Quality quality : {Quality::Fast, Quality::High, Quality::Compact}) {
    for (const auto& [name, mesh] : hard::small_closed_meshes<TypeParam>()) {
      this->expect_no_leak(name, mesh, 2, 20, quality);
    }
  }
}

TYPED_TEST(Watertight, from_the_centre_of_a_ball_every_ray_hits) {
  using Real = TypeParam;
  const auto ball = hard::icosphere<Real>(5);
  const auto scene = Scene<Real>::build(ball.view());
  for (const auto& ray : this->rays_outward(ball, {{0, 0, 0}})) {
    ASSERT_TRUE(scene.closest_hit(ray).has_value()) << show::text(ray);
  }
}

TYPED_TEST(Watertight, the_bunny_has_no_leak_at_any_vertex_or_edge) {
  this->expect_no_leak("bunny", hard::bunny<TypeParam>(), 1, 40);
}

// The far side of rounding: the mesh of a small thing in the middle of a large country.
TYPED_TEST(Watertight, georeferenced_meshes_have_no_leak) {
  using Real = TypeParam;
  for (auto [name, mesh] : hard::small_closed_meshes<Real>()) {
    for (auto& v : mesh.vertices) {
      v = {v.x * 64 + Real(512345.6), v.y * 64 + Real(5412345.6), v.z * 64 + Real(417.2)};
    }
    this->expect_no_leak(name, mesh, 2, 30);
  }
}

}  // namespace
}  // namespace pierce
