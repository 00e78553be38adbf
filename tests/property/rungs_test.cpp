// SPDX-License-Identifier: Apache-2.0
//
// What the statistics say: on hard rays every kind of query comes down to every rung of the ladder,
// so that whatever is held against an oracle there has been through all of them; and counting
// changes no answer.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/hard_rays.h"
#include "support/meshes.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class Rungs : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Rungs, Reals);

template <class Real>
struct Soup {
  Mesh<Real> mesh;
  std::vector<Ray<Real>> rays;
  std::vector<Vec3<Real>> points;
};

// Rays at the hard places of soups of every style, and points in space or on their corners.
template <class Real>
std::vector<Soup<Real>> hard_soups(std::size_t of_each_style) {
  std::vector<Soup<Real>> soups;
  for (std::uint64_t i = 0; i < of_each_style * hard::kAllStyles.size(); ++i) {
    Rng rng(hard::seed() + 95, i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    Soup<Real> soup{hard::soup<Real>(rng, style, 30), {}, {}};
    soup.mesh = hard::copies(rng, soup.mesh, 2);
    for (int k = 0; k < 40; ++k) {
      soup.rays.push_back(hard::aimed_ray(rng, soup.mesh, style).ray);
      soup.points.push_back(rng.coin() ? hard::vec<Real>(rng, style)
                                       : soup.mesh.vertices[rng.below(soup.mesh.vertices.size())]);
      if (rng.coin()) hard::component(soup.points.back(), rng.below(3)) = soup.points.front().x;
    }
    soups.push_back(std::move(soup));
  }
  return soups;
}

// Sums what `ask(scene, soup, statistics)` adds up over all soups.
template <class Real, class Ask>
Statistics sum_over(const std::vector<Soup<Real>>& soups, Ask ask) {
  Statistics sum;
  for (const auto& soup : soups) ask(Scene<Real>::build(soup.mesh.view()), soup, sum);
  return sum;
}

void expect_all_rungs(const char* query, const Statistics& s) {
  EXPECT_GT(s.candidates, 0U) << query;
  EXPECT_GT(s.certified, 0U) << query;
  EXPECT_GT(s.settled, 0U) << query;
  EXPECT_GT(s.settled_big, 0U) << query;
}

TYPED_TEST(Rungs, hard_rays_reach_every_rung_in_every_kind_of_query) {
  using Real = TypeParam;
  const auto soups = hard_soups<Real>(2);
  const auto rays_of = [](const Soup<Real>& soup) { return std::span(soup.rays); };
  const auto closest = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    std::vector<Hit<Real>> hits(soup.rays.size());
    scene.closest_hits(rays_of(soup), hits, {.work = {.statistics = &sum}});
  });
  const auto any = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    std::vector<std::uint8_t> hits(soup.rays.size());
    scene.any_hits(rays_of(soup), hits, {.work = {.statistics = &sum}});
  });
  const auto all = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    (void)scene.all_hits(rays_of(soup), {.work = {.statistics = &sum}});
  });
  const auto stepped = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    BatchOptions options;
    options.distinct = true;
    options.work.statistics = &sum;
    (void)scene.all_hits(rays_of(soup), options);
  });
  const auto counted = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    std::vector<std::uint32_t> counts(soup.rays.size());
    scene.count_hits(rays_of(soup), counts, {.work = {.statistics = &sum}});
  });
  const auto crossed = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    std::vector<Crossings> crossings(soup.rays.size());
    scene.crossings(rays_of(soup), crossings, {.work = {.statistics = &sum}});
  });
  const auto located = sum_over(soups, [&](const auto& scene, const auto& soup, auto& sum) {
    std::vector<Location> locations(soup.points.size());
    scene.locate(soup.points, locations, {.open_mesh = true, .work = {.statistics = &sum}});
  });
  expect_all_rungs("closest", closest);
  expect_all_rungs("any", any);
  expect_all_rungs("all", all);
  expect_all_rungs("count", counted);
  expect_all_rungs("crossings", crossed);
  expect_all_rungs("locate", located);
  // (Other queries leave out what is surely farther, or put it in order by intervals.)
  EXPECT_GT(stepped.orders_certified, 0U);
  for (const Statistics* s : {&closest, &all}) {
    EXPECT_GT(s->orders_settled, 0U);
    EXPECT_GT(s->rounded_exactly, 0U);
    EXPECT_GT(s->rays_placed_exactly, 0U);
  }
  // Every candidate of which float is not certain is decided, once, on one of the other rungs.
  EXPECT_LE(all.certified + all.settled + all.settled_big, all.candidates);
  EXPECT_EQ(all.certified, counted.certified);
  EXPECT_EQ(all.settled, counted.settled);
  EXPECT_EQ(all.settled_big, counted.settled_big);
  EXPECT_EQ(crossed.certified + crossed.settled + crossed.settled_big, crossed.candidates);
  EXPECT_EQ(all.hits, counted.hits);
  EXPECT_LE(any.certified + any.settled + any.settled_big, any.candidates);
}

TYPED_TEST(Rungs, counting_changes_no_answer_and_adds_up) {
  using Real = TypeParam;
  for (const auto& soup : hard_soups<Real>(1)) {
    const auto scene = Scene<Real>::build(soup.mesh.view());
    std::vector<Hit<Real>> plain(soup.rays.size()), counted(soup.rays.size());
    Statistics once, twice;
    scene.closest_hits(soup.rays, plain, {.work = {.threads = 1}});
    scene.closest_hits(soup.rays, counted, {.work = {.threads = 1, .statistics = &once}});
    for (std::size_t i = 0; i < plain.size(); ++i) {
      ASSERT_TRUE(show::same_bits(plain[i], counted[i])) << show::text(soup.rays[i]);
    }
    scene.closest_hits(soup.rays, counted, {.work = {.threads = 2, .statistics = &twice}});
    scene.closest_hits(soup.rays, counted, {.work = {.threads = 1, .statistics = &twice}});
    EXPECT_EQ(once.rays, soup.rays.size());
    EXPECT_EQ(twice.rays, 2 * once.rays);
    EXPECT_EQ(twice.hits, 2 * once.hits);
    EXPECT_EQ(twice.candidates, 2 * once.candidates);
    EXPECT_EQ(twice.certified, 2 * once.certified);
    EXPECT_EQ(twice.settled, 2 * once.settled);
    EXPECT_EQ(twice.settled_big, 2 * once.settled_big);
    EXPECT_EQ(twice.rounded_exactly, 2 * once.rounded_exactly);
  }
}

}  // namespace
}  // namespace pierce
