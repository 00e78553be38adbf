// SPDX-License-Identifier: Apache-2.0
//
// Lists of hits in all their forms: the first k are the beginning of the list, a count is its
// length, and the pieces of a stream laid end to end are the batch, within the documented bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "pierce/scene.h"
#include "support/compare_scene.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class HitListForms : public testing::Test {
 public:
  static Mesh<Real> layers(int count) {
    Mesh<Real> mesh;
    for (int i = 0; i < count; ++i) {
      const auto z = static_cast<Real>(i);
      const std::uint32_t a = mesh.add({-2, -2, z});
      mesh.triangles.push_back({a, mesh.add({6, -2, z}), mesh.add({-2, 6, z})});
    }
    return mesh;
  }

  // Some rays pierce all layers, most none; the dense ones come in runs and alone.
  static std::vector<Ray<Real>> rays_through(int count) {
    std::vector<Ray<Real>> rays;
    for (int i = 0; i < count; ++i) {
      const bool through = i % 3000 > 2700 || i % 97 == 0;
      const auto x = static_cast<Real>(i % 32) / 32;
      rays.push_back({{through ? x : 9, 0, -1}, {0, 0, 1}});
    }
    return rays;
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(HitListForms, Reals);

TYPED_TEST(HitListForms, the_first_k_of_many_coincident_hits_are_those_with_the_smallest_names) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 21);
  const auto mesh = hard::copies(rng, hard::icosphere<Real>(0), 40);
  const auto scene = Scene<Real>::build(mesh.view());
  const oracle::BruteForce<Real> truth(mesh.view());
  for (int i = 0; i < 40; ++i) {
    const auto ray = hard::aimed_ray(rng, mesh, Style::Unit).ray;
    const auto expected = truth.all_hits(ray);
    EXPECT_EQ(scene.count_hits(ray), expected.size());
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{7}, expected.size() / 2,
                                expected.size(), expected.size() + 1}) {
      std::vector<Hit<Real>> hits;
      scene.all_hits(ray, hits, {.max_hits = k});
      const auto first = std::span(expected).first(std::min(k, expected.size()));
      ASSERT_TRUE(show::same_bits<Real>(hits, first)) << show::text(ray) << " k " << k;
    }
  }
}

TYPED_TEST(HitListForms, pieces_of_a_stream_are_the_batch_and_keep_their_bounds) {
  using Real = TypeParam;
  const auto mesh = this->layers(400);
  const auto scene = Scene<Real>::build(mesh.view());
  const auto rays = this->rays_through(7000);
  const auto batch = scene.all_hits(rays);
  ASSERT_GT(batch.hits.size(), 250'000U);
  for (const unsigned threads : {1U, 2U, 3U}) {
    std::uint64_t next = 0, hits = 0;
    std::size_t full = 0;
    Statistics statistics;
    const BatchOptions options{.work = {.threads = threads, .statistics = &statistics}};
    scene.all_hits(rays, options, [&](std::uint64_t first, const HitLists<Real>& lists) {
      ASSERT_EQ(first, next);
      ASSERT_GT(lists.offsets.size(), 1U);
      ASSERT_LE(lists.offsets.size() - 1, 1024U);
      ASSERT_EQ(lists.offsets.back(), lists.hits.size());
      ASSERT_LT(*(lists.offsets.end() - 2), 65536U);
      full += lists.hits.size() >= 65536 ? 1 : 0;
      for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i, ++next) {
        ASSERT_TRUE(show::same_bits<Real>(lists.of(i), batch.of(next))) << "ray " << next;
      }
      hits += lists.hits.size();
    });
    EXPECT_EQ(next, rays.size());
    EXPECT_EQ(hits, batch.hits.size());
    EXPECT_GT(full, 0U) << "no piece was full before its end";
    EXPECT_EQ(statistics.rays, rays.size());
    EXPECT_EQ(statistics.hits, hits);
  }
}

TYPED_TEST(HitListForms, what_the_consumer_throws_ends_the_stream_and_reaches_the_caller) {
  using Real = TypeParam;
  const auto mesh = this->layers(3);
  const auto scene = Scene<Real>::build(mesh.view());
  const auto rays = this->rays_through(20000);
  int pieces = 0;
  const auto throws = [&](std::uint64_t, const HitLists<Real>&) {
    if (++pieces == 3) throw std::out_of_range("enough");
  };
  EXPECT_THROW(scene.all_hits(rays, {}, throws), std::out_of_range);
  EXPECT_EQ(pieces, 3);
  EXPECT_EQ(scene.all_hits(rays).offsets.size(), rays.size() + 1);  // the scene is none the worse
}

TYPED_TEST(HitListForms, a_stop_by_the_consumer_ends_the_stream) {
  using Real = TypeParam;
  const auto mesh = this->layers(3);
  const auto scene = Scene<Real>::build(mesh.view());
  const auto rays = this->rays_through(60000);
  std::atomic<bool> source = false;
  const auto stops = [&](std::uint64_t, const HitLists<Real>&) { source = true; };
  try {
    scene.all_hits(rays, {.work = {.stop = &source}}, stops);
    FAIL() << "not stopped";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::Stopped);
  }
}

TYPED_TEST(HitListForms, a_stream_without_rays_hands_over_nothing) {
  using Real = TypeParam;
  const auto scene = Scene<Real>::build(this->layers(1).view());
  const std::vector<Ray<Real>> none;
  scene.all_hits(none, {}, [](std::uint64_t, const HitLists<Real>&) { FAIL(); });
}

}  // namespace
}  // namespace pierce
