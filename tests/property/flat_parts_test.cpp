// SPDX-License-Identifier: Apache-2.0
//
// Rays that do not move along an axis never look at what stands across it. What they do hit they
// hit all the same: among flat parts and slanted ones, in their planes and beside them, with
// directions that are zero, or only in float, and after a refit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pierce/intersect.h"
#include "pierce/scene.h"
#include "support/rng.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;

template <class Real>
struct Soup {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;

  void add(const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
  }
  [[nodiscard]] MeshView<Real> view() const { return {vertices, triangles}; }
};

template <class Real>
Real& component(Vec3<Real>& p, int k) {
  return k == 0 ? p.x : k == 1 ? p.y : p.z;
}

template <class Real>
Real grid(Rng& rng) {
  return static_cast<Real>(rng.between(-8, 8)) / 2;
}

// Most of the triangles stand across an axis.
template <class Real>
Soup<Real> houses(Rng& rng, int count) {
  Soup<Real> soup;
  for (int i = 0; i < count; ++i) {
    Vec3<Real> p[3];
    for (Vec3<Real>& corner : p) corner = {grid<Real>(rng), grid<Real>(rng), grid<Real>(rng)};
    const int axis = rng.between(0, 2);
    if (!rng.one_in(6)) component(p[1], axis) = component(p[2], axis) = component(p[0], axis);
    soup.add(p[0], p[1], p[2]);
  }
  return soup;
}

// On the grid, and along one of its planes.
template <class Real>
Ray<Real> ray_along(Rng& rng) {
  Ray<Real> ray{{grid<Real>(rng), grid<Real>(rng), grid<Real>(rng)},
                {grid<Real>(rng), grid<Real>(rng), grid<Real>(rng)}};
  component(ray.direction, rng.between(0, 2)) = rng.coin() ? Real(0) : -Real(0);
  if (rng.one_in(3)) component(ray.direction, rng.between(0, 2)) = 0;
  if (rng.one_in(4)) component(ray.direction, rng.between(0, 2)) *= Real(0x1p-140);
  if (ray.direction == Vec3<Real>{0, 0, 0}) ray.direction.x = 1;
  if (rng.coin()) ray.origin.x += Real(0.1);
  ray.t_min = rng.coin() ? 0 : -8;
  return ray;
}

// All hits, triangle by triangle.
template <class Real>
std::vector<Hit<Real>> hits_of(const Soup<Real>& soup, const Ray<Real>& ray) {
  std::vector<Hit<Real>> hits;
  for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) {
    const auto& [a, b, c] = soup.triangles[i];
    auto hit = intersect(ray, soup.vertices[a], soup.vertices[b], soup.vertices[c]);
    if (!hit) continue;
    hit->geometry = 0;
    hit->triangle = i;
    hits.push_back(*hit);
  }
  std::stable_sort(hits.begin(), hits.end(),
                   [](const Hit<Real>& p, const Hit<Real>& q) { return p.t < q.t; });
  return hits;
}

// Every query, one by one and as a batch.
template <class Real>
void check(const Scene<Real>& scene, const Soup<Real>& soup, const std::vector<Ray<Real>>& rays) {
  std::vector<Hit<Real>> closest(rays.size()), found;
  std::vector<std::uint8_t> any(rays.size());
  scene.closest_hits(std::span<const Ray<Real>>(rays), std::span<Hit<Real>>(closest));
  scene.any_hits(std::span<const Ray<Real>>(rays), std::span<std::uint8_t>(any));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto expected = hits_of(soup, rays[i]);
    const auto what = [&] {
      return show::text(rays[i].origin) + show::text(rays[i].direction) + std::to_string(i);
    };
    scene.all_hits(rays[i], found);
    ASSERT_EQ(found.size(), expected.size()) << what();
    ASSERT_EQ(scene.any_hit(rays[i]), !expected.empty()) << what();
    ASSERT_EQ(any[i] != 0, !expected.empty()) << what();
    const auto first = scene.closest_hit(rays[i]);
    ASSERT_EQ(first.has_value(), !expected.empty()) << what();
    ASSERT_EQ(closest[i].triangle == kNone, expected.empty()) << what();
    if (expected.empty()) continue;
    ASSERT_TRUE(show::same_bits(*first, found[0])) << what();
    ASSERT_TRUE(show::same_bits(closest[i], found[0])) << what();
    ASSERT_EQ(found[0].t, expected[0].t) << what();
    for (const Hit<Real>& hit : found) {
      const auto there = std::find_if(expected.begin(), expected.end(), [&](const Hit<Real>& e) {
        return e.triangle == hit.triangle && show::same_bits(e, hit);
      });
      ASSERT_NE(there, expected.end()) << what();
    }
  }
}

template <class Real>
class FlatParts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FlatParts, Reals);

TYPED_TEST(FlatParts, are_hit_by_whatever_moves_across_them) {
  for (std::uint64_t i = 0; i < hard::case_count(20); ++i) {
    Rng rng(hard::seed() + 700, i);
    const auto soup = houses<TypeParam>(rng, 150);
    const auto scene = Scene<TypeParam>::build(soup.view());
    std::vector<Ray<TypeParam>> rays;
    for (int k = 0; k < 120; ++k) rays.push_back(ray_along<TypeParam>(rng));
    check(scene, soup, rays);
    if (this->HasFatalFailure()) return;
  }
}

// Fans of sixteen in one plane go as packets.
TYPED_TEST(FlatParts, are_hit_by_coherent_rays) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(20); ++i) {
    Rng rng(hard::seed() + 701, i);
    const auto soup = houses<Real>(rng, 150);
    const auto scene = Scene<Real>::build(soup.view());
    std::vector<Ray<Real>> rays;
    for (int fan = 0; fan < 8; ++fan) {
      const Ray<Real> first = ray_along<Real>(rng);
      const int still = rng.between(0, 2);
      const bool exactly = rng.coin();
      for (int k = 0; k < 16; ++k) {
        Ray<Real> ray = first;
        ray.direction = {8, 12, 16};
        component(ray.direction, (still + 1) % 3) += static_cast<Real>(k) / 32;
        component(ray.direction, still) = exactly || k != 9 ? Real(0) : Real(0x1p-146);
        rays.push_back(ray);
      }
    }
    check(scene, soup, rays);
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(FlatParts, are_no_longer_flat_after_a_refit) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(10); ++i) {
    Rng rng(hard::seed() + 702, i);
    auto soup = houses<Real>(rng, 100);
    auto moved = soup;
    for (Vec3<Real>& p : moved.vertices) component(p, rng.between(0, 2)) += grid<Real>(rng) / 64;
    auto scene = Scene<Real>::build(soup.view());
    std::vector<Ray<Real>> rays;
    for (int k = 0; k < 60; ++k) rays.push_back(ray_along<Real>(rng));
    for (const auto* now : {&moved, &soup, &moved}) {
      scene.refit(now->view());
      check(scene, *now, rays);
      if (this->HasFatalFailure()) return;
    }
  }
}

// The direction is no longer there once it is a float of size 1, but the origin is on the plane.
TEST(FlatPartsOfFloats, are_hit_by_a_ray_that_moves_by_less_than_a_float_tells) {
  Soup<float> soup;
  for (int i = -20; i < 20; ++i) {
    const auto x = static_cast<float>(i);
    soup.add({x, 1, 0}, {x + 2, 1, 0}, {x, 1, 2});
  }
  const auto scene = Scene<float>::build(soup.view());
  std::vector<Ray<float>> rays;
  for (int i = -20; i < 20; ++i) {
    rays.push_back({{static_cast<float>(i) + 0.25F, 1, 0.5F}, {0x1p60F, 0x1p-149F, 0}});
    rays.push_back({{static_cast<float>(i) + 0.25F, 1, 0.5F}, {0x1p60F, 0, 0}});
  }
  check(scene, soup, rays);
  EXPECT_TRUE(scene.any_hit(rays[0]));
  EXPECT_FALSE(scene.any_hit(rays[1]));
}

// Corners that lie in one plane only where filter space has rounded them away.
TEST(FlatPartsOfDoubles, are_flat_where_the_scene_has_them) {
  Soup<double> soup;
  for (int i = -20; i < 20; ++i) {
    const double x = i * 1e299;
    soup.add({x, 1e-300, 0}, {x + 2e299, 2e-300, 0}, {x, 3e-300, 2e299});
  }
  const auto scene = Scene<double>::build(soup.view());
  std::vector<Ray<double>> rays;
  for (int i = -20; i < 20; ++i) {
    rays.push_back({{i * 1e299, 2e-300, 1e298}, {1, 0, 0}});
    rays.push_back({{i * 1e299, 2e-300, 1e298}, {1, 0, 0x1p-1074}});
  }
  check(scene, soup, rays);
  EXPECT_TRUE(scene.any_hit(rays[0]));
}

}  // namespace
}  // namespace pierce
