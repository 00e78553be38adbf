// SPDX-License-Identifier: Apache-2.0
//
// Options that do not fit the scene or the batch are refused in one line that names the first
// offender and the cure; those that mean nothing change nothing.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "pierce/scene.h"

namespace pierce {
namespace {

const std::vector<Vec3<float>> kVertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Triangle> kTriangles = {{0, 1, 2}};
const MeshView<float> kMesh = {kVertices, kTriangles};
const Ray<float> kRay = {{0.25F, 0.25F, 1}, {0, 0, -1}};

void expect_refused(ErrorCode code, const std::string& text, const std::function<void()>& query) {
  try {
    query();
    ADD_FAILURE() << "not refused: " << text;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code);
    EXPECT_EQ(e.what(), text);
  }
}

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
    expect_refused(ErrorCode::InvalidArgument,
                   "bad triangle to skip, of ray 2 (the first of 2): there is no triangle 0 of "
                   "geometry 7; name one of the scene, or none",
                   [&] { query({.skip = skip}); });
    expect_refused(ErrorCode::SizeMismatch,
                   "there are 4 rays but 3 triangles to skip; give none, or one a ray",
                   [&] { query({.skip = std::span(skip).first(3)}); });
    const std::vector<std::uint32_t> masks(5, 1);
    expect_refused(ErrorCode::SizeMismatch, "there are 4 rays but 5 masks; give none, or one a ray",
                   [&] { query({.masks = masks}); });
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
