// SPDX-License-Identifier: Apache-2.0
//
// Meshes and rays of the benchmark: the same numbers on every machine and with every compiler.
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "pierce/closed.h"
#include "pierce/scene.h"
#include "workloads/generators.h"
#include "workloads/rays.h"

namespace pierce::bench {
namespace {

// FNV-1a over bytes; the structs hashed here have no padding.
template <class Element>
std::uint64_t hash(const std::vector<Element>& elements) {
  std::uint64_t h = 0xcbf29ce484222325U;
  const auto* bytes = reinterpret_cast<const unsigned char*>(elements.data());
  for (std::size_t i = 0; i < elements.size() * sizeof(Element); ++i)
    h = (h ^ bytes[i]) * 0x100000001b3U;
  return h;
}

std::uint64_t hash(const Mesh& mesh) { return hash(mesh.vertices) ^ hash(mesh.triangles); }

Caster exact_caster(const Scene<float>& scene) {
  return [&scene](std::span<const Ray<float>> rays, std::span<Hit<float>> hits) {
    scene.closest_hits(rays, hits);
  };
}

TEST(Workloads, meshes_are_the_same_on_every_machine) {
  EXPECT_EQ(hash(make_mesh("city")), 6473082578508385014U);
  EXPECT_EQ(hash(make_mesh("needles")), 13230354312131612707U);
  EXPECT_EQ(hash(make_icosphere(4)), 6813117979105753548U);
}

TEST(Workloads, meshes_have_the_sizes_they_promise) {
  EXPECT_EQ(make_mesh("city").triangles.size(), 480'002U);
  EXPECT_EQ(make_mesh("needles").triangles.size(), 100'000U);
  EXPECT_EQ(make_icosphere(3).triangles.size(), 1280U);
}

TEST(Workloads, dividing_keeps_a_closed_mesh_closed) {
  Mesh mesh = make_icosphere(2);
  ASSERT_TRUE(closedness(mesh.mesh_view()).closed);
  subdivide(mesh.vertices, mesh.triangles, 0.05);
  EXPECT_EQ(mesh.triangles.size(), 1280U);
  EXPECT_TRUE(closedness(mesh.mesh_view()).closed);
}

TEST(Workloads, ray_sets_are_full_valid_and_the_same_on_every_machine) {
  const Mesh mesh = make_icosphere(3);
  const auto scene = Scene<float>::build(mesh.mesh_view());
  RayMaker maker(mesh, exact_caster(scene), 32);
  std::vector<Ray<float>> all;
  for (const RayKind& kind : ray_kinds()) {
    const RaySet set = maker.make(kind.name);
    EXPECT_EQ(set.rays.size(), 1024U) << kind.name;
    ASSERT_EQ(set.rays_double.size(), set.rays.size());
    for (std::size_t i = 0; i < set.rays.size(); ++i)
      EXPECT_EQ(to_double(set.rays[i].direction), set.rays_double[i].direction);
    all.insert(all.end(), set.rays.begin(), set.rays.end());
  }
  std::vector<Hit<float>> hits(all.size());
  EXPECT_NO_THROW(scene.closest_hits(all, hits));  // batches check their rays
  EXPECT_EQ(hash(all), 4880101017137253173U);
}

TEST(Workloads, tiles_and_rows_hold_the_same_camera_rays) {
  const Mesh mesh = make_icosphere(2);
  const auto scene = Scene<float>::build(mesh.mesh_view());
  RayMaker maker(mesh, exact_caster(scene), 32);
  const auto directions = [&](const char* name) {
    std::multiset<std::tuple<float, float, float>> found;
    for (const Ray<float>& ray : maker.make(name).rays)
      found.emplace(ray.direction.x, ray.direction.y, ray.direction.z);
    return found;
  };
  EXPECT_EQ(directions("primary"), directions("rows"));
}

TEST(Workloads, a_thinned_set_is_spread_evenly) {
  RaySet set;
  for (int i = 0; i < 10; ++i) {
    set.rays.push_back({{static_cast<float>(i), 0, 0}, {1, 0, 0}});
    set.rays_double.push_back({{static_cast<double>(i), 0, 0}, {1, 0, 0}});
  }
  const RaySet few = thinned(set, 4);
  ASSERT_EQ(few.rays.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(few.rays[i].origin.x, static_cast<float>(thinned_place(i, 4, 10)));
  EXPECT_EQ(thinned(set, 100).rays.size(), 10U);
}

}  // namespace
}  // namespace pierce::bench
