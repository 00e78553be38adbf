// SPDX-License-Identifier: Apache-2.0
//
// Every query under every option (range, skip, sides, masks, max_hits) against the oracle: what a
// ray does not see is as if it did not exist. Single rays, and batches in which neighbours run
// alike but see different things, on soups of every style of number and coincident triangles.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/compare_scene.h"
#include "support/filtered_truth.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

constexpr std::array<std::uint32_t, 6> kMasks = {kAllBits, 1, 2, 3, 4, 0};

template <class Real>
struct World {
  std::vector<Mesh<Real>> meshes;
  std::vector<MeshView<Real>> views;
  std::vector<std::uint32_t> masks;

  static World draw(Rng& rng, Style style) {
    World world;
    for (int k = rng.between(1, 4); k > 0; --k) {
      world.meshes.push_back(
          hard::soup<Real>(rng, style, static_cast<std::uint32_t>(rng.between(1, 20))));
    }
    world.meshes.push_back(world.meshes.front());  // geometries that coincide
    for (const auto& mesh : world.meshes) {
      world.views.push_back(mesh.view());
      world.masks.push_back(rng.pick(kMasks));
    }
    return world;
  }
};

QueryOptions draw_options(Rng& rng, TriangleRef aimed_at) {
  QueryOptions options;
  options.range = rng.coin() ? Range::Closed : Range::OpenStart;
  if (rng.one_in(3)) options.skip = aimed_at;
  options.sides = rng.pick(std::array{Sides::Both, Sides::Front, Sides::Back});
  options.mask = rng.pick(kMasks);
  if (rng.coin()) options.max_hits = rng.below(4);
  return options;
}

std::string text(const QueryOptions& o) {
  return show::joined(" range ", static_cast<int>(o.range), " skip ", o.skip.geometry, ':',
                      o.skip.triangle, " sides ", static_cast<int>(o.sides), " mask ", o.mask,
                      " max_hits ", o.max_hits);
}

template <class Hits>
Hits first_of(Hits hits, std::uint64_t most) {
  if (hits.size() > most) hits.resize(most);
  return hits;
}

template <class Real>
class FiltersAgainstOracle : public testing::Test {
 public:
  static void expect_single(const Scene<Real>& scene, const oracle::FilteredTruth<Real>& truth,
                            const Ray<Real>& ray, const QueryOptions& options) {
    const auto expected = truth.all_hits(ray, options);
    const Hit<Real> first = expected.empty() ? Hit<Real>{} : expected.front();
    const std::string about = show::text(ray) + text(options);
    ASSERT_TRUE(show::same_bits(scene.closest_hit(ray, options).value_or(Hit<Real>{}), first))
        << about;
    ASSERT_EQ(scene.any_hit(ray, options), !expected.empty()) << about;
    std::vector<Hit<Real>> all(1);
    scene.all_hits(ray, all, options);
    ASSERT_TRUE(show::same_bits<Real>(all, first_of(expected, options.max_hits))) << about;
    ASSERT_EQ(scene.count_hits(ray, options), expected.size()) << about;
    ASSERT_EQ(scene.crossings(ray, options), truth.crossings(ray, options)) << about;
  }

  // The batch has one range, one choice of sides and one limit; skips and masks are each ray's.
  static void expect_batch(const Scene<Real>& scene, const oracle::FilteredTruth<Real>& truth,
                           std::span<const Ray<Real>> rays, const BatchOptions& options) {
    std::vector<Hit<Real>> closest(rays.size());
    std::vector<std::uint8_t> any(rays.size(), 7);
    std::vector<std::uint32_t> counts(rays.size(), 7);
    std::vector<Crossings> crossings(rays.size());
    scene.closest_hits(rays, closest, options);
    scene.any_hits(rays, any, options);
    scene.count_hits(rays, counts, options);
    scene.crossings(rays, crossings, options);
    const HitLists<Real> all = scene.all_hits(rays, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      QueryOptions one{.range = options.range, .sides = options.sides, .mask = options.mask};
      if (!options.skip.empty()) one.skip = options.skip[i];
      if (!options.masks.empty()) one.mask = options.masks[i];
      one.max_hits = options.max_hits;
      const auto expected = truth.all_hits(rays[i], one);
      const Hit<Real> first = expected.empty() ? Hit<Real>{} : expected.front();
      const std::string about = show::joined("ray ", i, ' ', show::text(rays[i]), text(one));
      ASSERT_TRUE(show::same_bits(closest[i], first)) << about << show::text(closest[i]);
      ASSERT_EQ(any[i], expected.empty() ? 0 : 1) << about;
      ASSERT_EQ(counts[i], expected.size()) << about;
      ASSERT_TRUE(show::same_bits<Real>(all.of(i), first_of(expected, one.max_hits))) << about;
      ASSERT_EQ(crossings[i], truth.crossings(rays[i], one)) << about;
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FiltersAgainstOracle, Reals);

TYPED_TEST(FiltersAgainstOracle, single_rays_see_what_their_options_leave) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(60); ++i) {
    Rng rng(hard::seed(), i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    const auto world = World<Real>::draw(rng, style);
    const BuildOptions build{.quality = static_cast<Quality>(rng.below(4)), .masks = world.masks};
    const auto scene = Scene<Real>::build(world.views, build);
    const oracle::FilteredTruth<Real> truth(world.views, world.masks);
    for (int k = 0; k < 12; ++k) {
      const auto geometry = static_cast<std::uint32_t>(rng.below(world.meshes.size()));
      const auto aimed = hard::aimed_ray(rng, world.meshes[geometry], style);
      const auto options = draw_options(rng, {geometry, aimed.triangle});
      this->expect_single(scene, truth, aimed.ray, options);
      if (testing::Test::HasFatalFailure()) FAIL() << "scene " << i;
    }
  }
}

TYPED_TEST(FiltersAgainstOracle, rays_of_a_batch_each_see_what_their_options_leave) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(40); ++i) {
    Rng rng(hard::seed(), 500 + i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    const auto world = World<Real>::draw(rng, style);
    const BuildOptions build{.quality = static_cast<Quality>(rng.below(4)), .masks = world.masks};
    const auto scene = Scene<Real>::build(world.views, build);
    const oracle::FilteredTruth<Real> truth(world.views, world.masks);
    std::vector<Ray<Real>> rays;
    std::vector<TriangleRef> skip;
    std::vector<std::uint32_t> masks;
    for (int k = 0; k < 8; ++k) {
      const auto geometry = static_cast<std::uint32_t>(rng.below(world.meshes.size()));
      const auto aimed = hard::aimed_ray(rng, world.meshes[geometry], style);
      // Enough alike in a row to go as a packet, and some that do not fill one.
      for (int copies = rng.coin() ? 16 : rng.between(1, 3); copies > 0; --copies) {
        rays.push_back(aimed.ray);
        skip.push_back(rng.coin() ? TriangleRef{} : TriangleRef{geometry, aimed.triangle});
        masks.push_back(rng.pick(kMasks));
      }
    }
    BatchOptions options{.work = {.threads = static_cast<unsigned>(1 + rng.below(2))}};
    const QueryOptions drawn = draw_options(rng, {});
    options.range = drawn.range;
    options.sides = drawn.sides;
    options.mask = drawn.mask;
    options.max_hits = drawn.max_hits;
    if (rng.coin()) options.skip = skip;
    if (rng.coin()) options.masks = masks;
    this->expect_batch(scene, truth, rays, options);
    if (testing::Test::HasFatalFailure()) FAIL() << "scene " << i;
  }
}

// A camera before two layers of one ball: the packets' case, where float alone would be certain.
TYPED_TEST(FiltersAgainstOracle, a_camera_sees_the_far_side_of_what_is_hidden_or_turned_away) {
  using Real = TypeParam;
  const auto ball = hard::icosphere<Real>(2);
  auto inner = ball;
  for (auto& v : inner.vertices) v = {v.x / 2, v.y / 2, v.z / 2};
  const std::vector<MeshView<Real>> views = {ball.view(), inner.view()};
  const std::vector<std::uint32_t> masks = {1, 2};
  const auto scene = Scene<Real>::build(views, {.masks = masks});
  const oracle::FilteredTruth<Real> truth(views, masks);
  std::vector<Ray<Real>> rays;
  for (int i = 0; i < 24 * 24; ++i) {
    const auto x = static_cast<Real>(i % 24) / 16 - Real(0.75);
    const auto y = static_cast<Real>(i / 24) / 16 - Real(0.75);
    rays.push_back({{0, 0, 4}, {x / 2, y / 2, -1}});
  }
  for (const Sides sides : {Sides::Both, Sides::Front, Sides::Back}) {
    for (const std::uint32_t mask : {kAllBits, 1U, 2U}) {
      this->expect_batch(scene, truth, rays, {.sides = sides, .mask = mask});
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

TYPED_TEST(FiltersAgainstOracle, a_coincident_copy_is_seen_where_the_first_is_not) {
  using Real = TypeParam;
  const Mesh<Real> one{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  const std::vector<MeshView<Real>> views(3, one.view());
  const std::vector<std::uint32_t> masks = {1, 2, 6};
  const auto scene = Scene<Real>::build(views, {.masks = masks});
  const Ray<Real> ray{{1, 1, 2}, {0, 0, -1}};
  const auto seen = [&](const QueryOptions& options) {
    const auto hit = scene.closest_hit(ray, options);
    return hit ? TriangleRef{hit->geometry, hit->triangle} : TriangleRef{};
  };
  EXPECT_EQ(seen({}), (TriangleRef{0, 0}));
  EXPECT_EQ(seen({.skip = {0, 0}}), (TriangleRef{0, 1}));
  EXPECT_EQ(seen({.sides = Sides::Back}), (TriangleRef{0, 1}));
  EXPECT_EQ(seen({.mask = 2}), (TriangleRef{1, 0}));
  EXPECT_EQ(seen({.skip = {2, 1}, .sides = Sides::Back, .mask = 4}), TriangleRef{});
  EXPECT_EQ(seen({.mask = 8}), TriangleRef{});
  EXPECT_EQ(scene.count_hits(ray), 6U);
  EXPECT_EQ(scene.count_hits(ray, {.mask = 2}), 4U);
  EXPECT_EQ(scene.crossings(ray, {.sides = Sides::Front}), (Crossings{3, -3, false}));
  EXPECT_EQ(scene.crossings({{1, 1, 0}, {1, 0, 0}}, {.sides = Sides::Front, .mask = 4}),
            (Crossings{0, 0, true}));
}

}  // namespace
}  // namespace pierce
