// SPDX-License-Identifier: Apache-2.0
//
// Options that do not fit the scene or the batch are refused in one line that names the first
// offender and the cure; those that mean nothing change nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pierce/scene.h"

namespace pierce {
namespace {

const std::vector<Vec3<float>> kVertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Triangle> kTriangles = {{0, 1, 2}};
const MeshView<float> kMesh = {kVertices, kTriangles};
const Ray<float> kRay = {{0.25F, 0.25F, 1}, {0, 0, -1}};

void expect_refused(ErrorCode code, const std::string& text, const std::function<void()>& query,
                    std::uint64_t index = Error::kNoIndex, std::uint64_t count = 1) {
  try {
    query();
    ADD_FAILURE() << "not refused: " << text;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code);
    EXPECT_EQ(e.what(), text);
    EXPECT_EQ(e.index(), index) << text;
    EXPECT_EQ(e.count(), count) << text;
  }
}

using Single = std::function<void(const QueryOptions&)>;
using Batch = std::function<void(const BatchOptions&)>;

/// Every query about the hits of one ray.
std::vector<Single> about_hits(const Scene<float>& scene, const Ray<float>& ray) {
  return {[&](const auto& o) { (void)scene.closest_hit(ray, o); },
          [&](const auto& o) { (void)scene.any_hit(ray, o); },
          [&](const auto& o) {
            std::vector<Hit<float>> hits;
            scene.all_hits(ray, hits, o);
          },
          [&](const auto& o) { (void)scene.count_hits(ray, o); }};
}

/// The same of a batch.
struct Batches {
  const Scene<float>& scene;
  std::vector<Ray<float>> rays;
  std::vector<Hit<float>> closest = std::vector<Hit<float>>(rays.size());
  std::vector<std::uint8_t> any = std::vector<std::uint8_t>(rays.size());
  std::vector<std::uint32_t> counts = std::vector<std::uint32_t>(rays.size());
  HitLists<float> lists = {};
  std::vector<std::uint64_t> pieces = {};  // the first ray of each

  [[nodiscard]] std::vector<Batch> about_hits() {
    return {[this](const auto& o) { scene.closest_hits(rays, closest, o); },
            [this](const auto& o) { scene.any_hits(rays, any, o); },
            [this](const auto& o) { lists = scene.all_hits(rays, o); },
            [this](const auto& o) {
              pieces.clear();
              scene.all_hits(rays, o,
                             [this](std::uint64_t first, const auto&) { pieces.push_back(first); });
            },
            [this](const auto& o) { scene.count_hits(rays, counts, o); }};
  }
};

TEST(QueryOptions, a_triangle_to_skip_must_exist_or_be_none) {
  const auto scene = Scene<float>::build(kMesh);
  const std::string text =
      "bad triangle to skip: there is no triangle 1 of geometry 0; name one of the scene, or none";
  std::vector<Hit<float>> hits;
  for (const auto& query : std::vector<std::function<void(const QueryOptions&)>>{
           [&](const auto& o) { (void)scene.closest_hit(kRay, o); },
           [&](const auto& o) { (void)scene.any_hit(kRay, o); },
           [&](const auto& o) { scene.all_hits(kRay, hits, o); },
           [&](const auto& o) { (void)scene.count_hits(kRay, o); },
           [&](const auto& o) { (void)scene.crossings(kRay, o); }}) {
    expect_refused(ErrorCode::InvalidArgument, text, [&] { query({.skip = {0, 1}}); });
    query({.skip = {0, 0}});
    query({.skip = {}});
  }
}

TEST(QueryOptions, a_batch_names_the_first_bad_triangle_to_skip_and_counts_them) {
  const auto scene = Scene<float>::build(kMesh);
  const std::vector<Ray<float>> rays(4, kRay);
  const std::vector<TriangleRef> skip = {{0, kNone}, {0, 0}, {7, 0}, {0, 99}};
  std::vector<Hit<float>> hits(4);
  std::vector<std::uint8_t> any(4);
  std::vector<std::uint32_t> counts(4);
  std::vector<Crossings> crossings(4);
  for (const auto& query : std::vector<std::function<void(const BatchOptions&)>>{
           [&](const auto& o) { scene.closest_hits(rays, hits, o); },
           [&](const auto& o) { scene.any_hits(rays, any, o); },
           [&](const auto& o) { (void)scene.all_hits(rays, o); },
           [&](const auto& o) { scene.all_hits(rays, o, [](auto, const auto&) {}); },
           [&](const auto& o) { scene.count_hits(rays, counts, o); },
           [&](const auto& o) { scene.crossings(rays, crossings, o); }}) {
    expect_refused(
        ErrorCode::InvalidArgument,
        "bad triangle to skip, of ray 2 (the first of 2): there is no triangle 0 of "
        "geometry 7; name one of the scene, or none",
        [&] { query({.skip = skip}); }, 2, 2);
    expect_refused(ErrorCode::SizeMismatch,
                   "there are 4 rays but 3 triangles to skip; give none, or one a ray",
                   [&] { query({.skip = std::span(skip).first(3)}); });
    const std::vector<std::uint32_t> masks(5, 1);
    expect_refused(ErrorCode::SizeMismatch, "there are 4 rays but 5 masks; give none, or one a ray",
                   [&] { query({.masks = masks}); });
  }
}

TEST(QueryOptions, a_triangle_to_go_on_after_must_be_hit_by_the_line) {
  const std::vector<Triangle> two = {{0, 1, 2}, {0, 1, 1}};
  const auto scene = Scene<float>::build({kVertices, two});
  for (const Single& query : about_hits(scene, kRay)) {
    expect_refused(ErrorCode::InvalidArgument,
                   "bad triangle to go on after: there is no triangle 2 of geometry 0; name one of "
                   "the scene, or none",
                   [&] {
                     query({.after = {0, 2}});
                   });
    expect_refused(ErrorCode::InvalidArgument,
                   "bad triangle to go on after: there is no triangle 0 of geometry 3; name one of "
                   "the scene, or none",
                   [&] {
                     query({.after = {3, 0}, .distinct = true});
                   });
    expect_refused(ErrorCode::InvalidArgument,
                   "bad triangle to go on after: the ray's line does not hit triangle 1 of "
                   "geometry 0; give a hit of this ray, or none",
                   [&] {
                     query({.after = {0, 1}});
                   });
    query({.after = {0, 0}});
    query({.after = {}});
  }
  // Behind the ray's origin, or out of its range: hit by the line all the same.
  const Ray<float> away{{0.25F, 0.25F, 1}, {0, 0, 1}, 5, 6};
  EXPECT_FALSE(scene.any_hit(away, {.after = {0, 0}}));
}

TEST(QueryOptions, a_batch_names_the_first_bad_triangle_to_go_on_after_and_counts_them) {
  const auto scene = Scene<float>::build(kMesh);
  Batches batches{scene, std::vector<Ray<float>>(2000, kRay)};
  batches.rays[1500].origin.x = 7;
  batches.rays[1700].origin.x = 7;
  batches.rays[1800].origin.x = 7;  // goes on after none
  std::vector<TriangleRef> after(2000, {0, 0});
  after[1800] = {};
  for (const Batch& query : batches.about_hits()) {
    expect_refused(
        ErrorCode::InvalidArgument,
        "bad triangle to go on after, of ray 1500 (the first of 2): the ray's line does not hit "
        "triangle 0 of geometry 0; give a hit of this ray, or none",
        [&] { query({.after = after, .work = {.threads = 3}}); }, 1500, 2);
    auto missing = after;
    missing[1499] = {9, 8};
    expect_refused(
        ErrorCode::InvalidArgument,
        "bad triangle to go on after, of ray 1499 (the first of 3): there is no triangle 8 of "
        "geometry 9; name one of the scene, or none",
        [&] { query({.after = missing, .distinct = true}); }, 1499, 3);
    expect_refused(ErrorCode::SizeMismatch,
                   "there are 2000 rays but 3 triangles to go on after; give none, or one a ray",
                   [&] { query({.after = std::span(after).first(3)}); });
    // A ray that is not valid, and may be, needs none.
    auto rays = batches.rays;
    for (const std::size_t i : {1500U, 1700U}) batches.rays[i].direction = {0, 0, 0};
    query({.after = after, .invalid = InvalidRays::Miss});
    expect_refused(
        ErrorCode::InvalidRay,
        "bad ray 1500 (the first of 2): its direction is zero; give it a component that is not",
        [&] { query({.after = after}); }, 1500, 2);
    batches.rays = rays;
  }
}

TEST(QueryOptions, crossings_are_not_asked_about_hits) {
  const auto scene = Scene<float>::build(kMesh);
  const std::vector<Ray<float>> rays(3, kRay);
  const std::vector<TriangleRef> after(3);
  std::vector<Crossings> crossings(3, {7, 7, true});
  const HitFilter all = [](std::uint64_t, const Hit<double>&) { return true; };
  const auto text = [](const std::string& option) {
    return "crossings are asked with " + option +
           ", which is about hits; ask all_hits or count_hits, or leave it out";
  };
  const auto refused = [&](const std::string& option, const QueryOptions& one,
                           const BatchOptions& batch) {
    expect_refused(ErrorCode::InvalidArgument, text(option),
                   [&] { (void)scene.crossings(kRay, one); });
    expect_refused(ErrorCode::InvalidArgument, text(option),
                   [&] { scene.crossings(rays, crossings, batch); });
  };
  refused("filter", {.filter = all}, {.filter = all});
  refused("after", {.after = {0, 0}}, {.after = after});
  refused("distinct", {.distinct = true}, {.distinct = true});
  EXPECT_EQ(crossings, std::vector<Crossings>(3, {7, 7, true})) << "nothing was asked";
  EXPECT_EQ(scene.crossings(kRay, {.after = {}}).count, 1U);
}

TEST(QueryOptions, rays_that_are_not_valid_may_miss) {
  const std::vector<Vec3<float>> corners = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
  const std::vector<Triangle> faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const auto scene = Scene<float>::build({corners, faces});
  const Ray<float> good{{1, 1, 1}, {0, 0, 1}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Ray<float>> bad = {
      {{1, nan, 1}, {0, 0, 1}},      {{1, 1, kInfinity<float>}, {0, 0, 1}},
      {{1, 1, 1}, {0, nan, 1}},      {{1, 1, 1}, {0, 0, -kInfinity<float>}},
      {{1, 1, 1}, {0, -0.0F, 0}},    {{1, 1, 1}, {0, 0, 1}, nan},
      {{1, 1, 1}, {0, 0, 1}, 0, nan}};
  const QueryOptions miss{.invalid = InvalidRays::Miss};
  for (const Ray<float>& ray : bad) {
    EXPECT_FALSE(scene.closest_hit(ray, miss));
    EXPECT_FALSE(scene.any_hit(ray, miss));
    EXPECT_EQ(scene.count_hits(ray, miss), 0U);
    EXPECT_EQ(scene.crossings(ray, miss), Crossings{});
    std::vector<Hit<float>> hits(3);
    scene.all_hits(ray, hits, miss);
    EXPECT_TRUE(hits.empty());
  }
  // Among good ones, in one block with them and in blocks of their own.
  std::vector<Ray<float>> rays(200, good);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i % 3 == 1 || i >= 100) rays[i] = bad[i % bad.size()];
  }
  const Hit<float> hit = scene.closest_hit(good).value();
  const auto start = scene.next_origin(good, hit, Side::Before);
  ASSERT_TRUE(start);
  std::vector<Crossings> crossings(rays.size(), {7, 7, true});
  std::vector<std::optional<Vec3<float>>> starts(rays.size(), Vec3<float>{7, 7, 7});
  const BatchOptions batch{.invalid = InvalidRays::Miss, .work = {.threads = 2}};
  scene.crossings(rays, crossings, batch);
  scene.next_origins(rays, std::vector<Hit<float>>(rays.size(), hit), Side::Before, starts, batch);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool is_good = i % 3 != 1 && i < 100;
    EXPECT_EQ(crossings[i], is_good ? scene.crossings(good) : Crossings{}) << i;
    EXPECT_EQ(starts[i], is_good ? start : std::nullopt) << i;
  }
}

TEST(QueryOptions, what_a_filter_throws_reaches_the_caller) {
  const std::vector<Triangle> three(3, Triangle{0, 1, 2});
  const auto scene = Scene<float>::build({kVertices, three});
  struct Refusal {
    std::uint64_t ray;
  };
  for (const Single& query : about_hits(scene, kRay)) {
    int asked = 0;
    const HitFilter filter = [&](std::uint64_t ray, const Hit<double>& hit) {
      ++asked;
      if (hit.triangle == 1) throw Refusal{ray};
      return false;
    };
    EXPECT_THROW(query({.filter = filter}), Refusal);
    EXPECT_EQ(asked, 2);
  }
  // Several threads throw at a time: one of these reaches the caller, the others end quietly.
  constexpr std::size_t kRays = 5000;
  Batches batches{scene, std::vector<Ray<float>>(kRays, kRay)};
  for (const unsigned threads : {1U, 4U}) {
    for (const Batch& query : batches.about_hits()) {
      std::atomic<int> thrown = 0;
      const HitFilter filter = [&](std::uint64_t ray, const Hit<double>& hit) {
        if (ray % 1000 == 999 && hit.triangle == 1) {
          ++thrown;
          throw Refusal{ray};
        }
        return hit.triangle != 0;
      };
      try {
        query({.filter = filter, .work = {.threads = threads}});
        ADD_FAILURE() << "nothing was thrown";
      } catch (const Refusal& refusal) {
        EXPECT_EQ(refusal.ray % 1000, 999U);
        EXPECT_LT(refusal.ray, kRays);
      } catch (...) {
        ADD_FAILURE() << "something else was thrown";
      }
      EXPECT_GE(thrown, 1);
      EXPECT_LE(thrown, 5);
      // All is as before: the same is asked again.
      query({.filter = [](std::uint64_t, const Hit<double>& hit) { return hit.triangle != 0; },
             .work = {.threads = threads}});
    }
  }
}

TEST(QueryOptions, a_scene_has_no_masks_or_one_a_geometry) {
  const std::vector<MeshView<float>> meshes(2, kMesh);
  const std::vector<std::uint32_t> masks(3, 1);
  expect_refused(ErrorCode::SizeMismatch,
                 "there are 2 geometries but 1 masks: geometry 1 has none; give none, or one a "
                 "geometry",
                 [&] { Scene<float>::build(meshes, {.masks = std::span(masks).first(1)}); });
  expect_refused(ErrorCode::SizeMismatch,
                 "there are 2 geometries but 3 masks: there is no geometry 2; give none, or one a "
                 "geometry",
                 [&] { Scene<float>::build(meshes, {.masks = masks}); });
}

TEST(QueryOptions, masks_are_copied_when_the_scene_is_built) {
  const std::vector<MeshView<float>> meshes(2, kMesh);
  std::vector<std::uint32_t> masks = {1, 2};
  const auto scene = Scene<float>::build(meshes, {.masks = masks});
  masks = {0, 0};
  EXPECT_EQ(scene.count_hits(kRay), 2U);
  EXPECT_EQ(scene.closest_hit(kRay, {.mask = 2})->geometry, 1U);
}

TEST(QueryOptions, masks_mean_nothing_to_points_and_next_origins) {
  const std::vector<Vec3<float>> corners = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
  const std::vector<Triangle> faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const std::vector<MeshView<float>> meshes = {{corners, faces}};
  const std::vector<std::uint32_t> hidden = {0};
  const auto scene = Scene<float>::build(meshes, {.masks = hidden});
  EXPECT_EQ(scene.count_hits(kRay), 0U);
  EXPECT_EQ(scene.crossings(kRay), Crossings{});
  EXPECT_EQ(scene.locate({1, 1, 1}), Location::Inside);
  EXPECT_EQ(scene.nearest_point({1, 1, -2})->distance, 2);
  const auto seen = Scene<float>::build(meshes);
  const auto hit = seen.closest_hit({{1, 1, -1}, {0, 0, 1}}).value();
  EXPECT_EQ(scene.next_origin({{1, 1, -1}, {0, 0, 1}}, hit, Side::Beyond),
            seen.next_origin({{1, 1, -1}, {0, 0, 1}}, hit, Side::Beyond));
}

}  // namespace
}  // namespace pierce
