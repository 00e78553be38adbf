// SPDX-License-Identifier: Apache-2.0
//
// Distance does not blur: rays that start where cameras stand, or 2^20 to 2^100 sizes of the scene
// away, or point at it from there with directions of mixed magnitude, and scenes far from the
// origin of coordinates.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "support/closed_meshes.h"
#include "support/compare_scene.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::AimedRay;
using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class Far : public testing::Test {
 public:
  /// From 2^far away, towards a feature of the mesh: rounded, so that exact hits are rare but along
  /// an axis, where the direction keeps what is needed.
  static AimedRay<Real> far_ray(Rng& rng, const Mesh<Real>& mesh, int far) {
    for (;;) {
      auto aimed = hard::aimed_ray(rng, mesh, Style::Unit);
      const Triangle& t = mesh.triangles[aimed.triangle];
      const auto target = rng.coin() ? mesh.vertices[t[0]] : mesh.vertices[t[1]];
      Vec3<Real> away = rng.coin() ? hard::vec<Real>(rng, Style::Unit)
                                   : hard::vec<Real>(rng, Style::SmallInteger);
      if (rng.coin()) {
        const std::size_t axis = rng.below(3);
        hard::component(away, (axis + 1) % 3) = 0;
        hard::component(away, (axis + 2) % 3) = 0;
      }
      auto& o = aimed.ray.origin;
      const auto exact_target = oracle::exact(target);
      o = hard::rounded_point<Real>(exact_target +
                                    oracle::Dyadic(mpz_class(1), far) * oracle::exact(away));
      auto& d = aimed.ray.direction;
      d = hard::rounded_point<Real>(oracle::Dyadic(mpz_class(1), -rng.between(0, far)) *
                                    (exact_target - oracle::exact(o)));
      aimed.ray.t_min = -std::numeric_limits<Real>::infinity();
      aimed.ray.t_max = std::numeric_limits<Real>::infinity();
      if (hard::is_valid(aimed.ray)) return aimed;
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Far, Reals);

TYPED_TEST(Far, origins_2_to_the_100_sizes_away_are_exact) {
  using Real = TypeParam;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    for (const int far : {0, 1, 2, 3, 4, 5, 6, 10, 20, 27, 29, 40, 60, 100}) {
      Rng rng(hard::seed(), static_cast<std::uint64_t>(far));
      std::vector<AimedRay<Real>> rays;
      for (int i = 0; i < 40; ++i) rays.push_back(this->far_ray(rng, mesh, far));
      const auto found = oracle::difference(mesh, rays);
      ASSERT_FALSE(found) << name << " from 2^" << far << ", seed " << hard::seed() << "\n"
                          << *found;
    }
  }
}

TYPED_TEST(Far, a_ray_along_an_axis_hits_from_any_distance) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(4);
  const auto scene = Scene<Real>::build(cube.view());
  for (int far = 0; far <= 120; ++far) {
    const Real z = std::ldexp(Real(1), far);
    for (const Real x : {Real(0), Real(1), Real(1.5), Real(4)}) {
      const auto hit = scene.closest_hit({{x, 2, -z}, {0, 0, 1}});
      ASSERT_TRUE(hit.has_value()) << "from 2^" << far;
      EXPECT_EQ(hit->t, z);
      EXPECT_FALSE(scene.any_hit({{-std::numeric_limits<Real>::denorm_min(), 2, -z}, {0, 0, 1}}));
    }
  }
}

TYPED_TEST(Far, georeferenced_scenes_are_exact) {
  using Real = TypeParam;
  for (auto [name, mesh] : hard::small_closed_meshes<Real>()) {
    for (const Real offset : {Real(1e4), Real(5.4e6), Real(1e9)}) {
      Mesh<Real> moved = mesh;
      for (auto& v : moved.vertices) v = {v.x * 16 + offset, v.y * 16 - offset / 3, v.z * 16};
      Rng rng(hard::seed(), 12);
      std::vector<AimedRay<Real>> rays;
      for (int i = 0; i < 40; ++i)
        rays.push_back(hard::aimed_ray(rng, moved, Style::Georeferenced));
      const auto found = oracle::difference(moved, rays);
      ASSERT_FALSE(found) << name << " at " << offset << "\n" << *found;
    }
  }
}

// One vertex far off makes the box of the scene so large that the rest is a point in it.
TYPED_TEST(Far, one_far_vertex_does_not_blur_the_rest) {
  using Real = TypeParam;
  for (const int far : {30, 60, 120}) {
    auto mesh = hard::icosphere<Real>(2);
    const auto last = mesh.add({std::ldexp(Real(1), far), 3, 5});
    mesh.triangles.push_back({0, 1, last});
    Rng rng(hard::seed(), 13);
    std::vector<AimedRay<Real>> rays;
    for (int i = 0; i < 60; ++i) rays.push_back(hard::aimed_ray(rng, mesh, Style::Unit));
    const auto found = oracle::difference(mesh, rays);
    ASSERT_FALSE(found) << "2^" << far << "\n" << *found;
  }
}

// Rays so near a corner at the origin that they lose bits on the way to filter space, through the
// plane of the triangles around it: which of them is hit, and where, is in these bits.
TEST(Near, a_corner_at_the_origin_is_told_from_what_is_beside_it) {
  constexpr float kSize = 0x1p20F;
  Mesh<float> cross;
  cross.vertices = {{0, 0, 0}, {kSize, 0, 0}, {0, kSize, 0}, {-kSize, 0, 0}, {0, -kSize, 0}};
  cross.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  Rng rng(hard::seed(), 14);
  std::vector<AimedRay<float>> rays;
  for (int i = 0; i < 4000; ++i) {
    const double small = std::ldexp(1 + rng.unit(), rng.between(-128, -60));
    const double dx = rng.symmetric(), dy = rng.symmetric();
    // To within a rounding of the corner.
    rays.push_back({{{static_cast<float>(-small * dx), static_cast<float>(-small * dy),
                      static_cast<float>(small)},
                     {static_cast<float>(dx), static_cast<float>(dy), -1}},
                    Range::Closed,
                    0});
  }
  const auto found = oracle::difference(cross, rays);
  ASSERT_FALSE(found) << *found;
}

// Sheets that lie closer than float tells apart, entered just beside an edge, where float is not
// sure of a hit: each is told in double, and which comes first exactly.
TEST(Near, sheets_are_told_apart_beside_their_edges) {
  Mesh<float> sheets;
  Rng rng(hard::seed(), 15);
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto z = static_cast<float>(std::ldexp(1 + rng.below(4000), -36));
    const auto first = static_cast<std::uint32_t>(sheets.vertices.size());
    sheets.vertices.insert(sheets.vertices.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
    sheets.triangles.push_back({first, first + 1, first + 2});
  }
  std::vector<AimedRay<float>> rays;
  for (int i = 0; i < 400; ++i) {
    const auto beside = static_cast<float>(std::ldexp(1 + rng.unit(), -rng.between(24, 40)));
    const auto along = static_cast<float>(0.1 + 0.8 * rng.unit());
    const float high = 1 + static_cast<float>(rng.unit());
    rays.push_back({{{beside, along, rng.coin() ? high : -high}, {0, 0, 0}}, Range::Closed, 0});
    rays.back().ray.direction = {0, static_cast<float>(std::ldexp(rng.symmetric(), -30)),
                                 -rays.back().ray.origin.z};
  }
  const auto found = oracle::difference(sheets, rays);
  ASSERT_FALSE(found) << *found;
}

}  // namespace
}  // namespace pierce
