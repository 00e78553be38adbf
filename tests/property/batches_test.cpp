// SPDX-License-Identifier: Apache-2.0
//
// A batch is nothing but its rays one by one: whatever the number of threads, the order of the
// rays, the quality of the tree and the number of times it is asked, every bit is the same.
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "pierce/scene.h"
#include "predicate/types.h"
#include "support/closed_meshes.h"
#include "support/compare_scene.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
struct Answers {
  std::vector<Hit<Real>> closest;
  std::vector<std::uint8_t> any;
  HitLists<Real> all;

  Answers(const Scene<Real>& scene, const std::vector<Ray<Real>>& rays, unsigned threads)
      : closest(rays.size()), any(rays.size()) {
    const BatchOptions options{.work = {.threads = threads}};
    scene.closest_hits(rays, closest, options);
    scene.any_hits(rays, any, options);
    all = scene.all_hits(rays, options);
  }

  [[nodiscard]] bool same_as(const Answers& other) const {
    return show::same_bits<Real>(closest, other.closest) && any == other.any &&
           all.offsets == other.all.offsets && show::same_bits<Real>(all.hits, other.all.hits);
  }
};

template <class Real>
class Batches : public testing::Test {
 public:
  /// Coherent rays (a camera), incoherent ones, hard ones; long enough to be split into chunks.
  static std::vector<Ray<Real>> draw_rays(const Mesh<Real>& mesh) {
    Rng rng(hard::seed(), 9);
    std::vector<Ray<Real>> rays;
    for (int i = 0; i < 64 * 64; ++i) {
      const auto x = static_cast<Real>(i % 64) / 64 - Real(0.5);
      const auto y = static_cast<Real>(i / 64) / 64 - Real(0.5);
      rays.push_back({{0, 0, 4}, {x, y, -1}});
    }
    for (int i = 0; i < 2000; ++i) {
      rays.push_back({hard::vec<Real>(rng, Style::Unit), hard::vec<Real>(rng, Style::Unit)});
    }
    for (int i = 0; i < 1000; ++i) {
      rays.push_back(hard::aimed_ray(rng, mesh, Style::Unit).ray);
      rays.push_back({hard::vec<Real>(rng, Style::Mixed), {0, 1, Real(1e-30)}});
    }
    return rays;
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Batches, Reals);

TYPED_TEST(Batches, every_thread_count_and_quality_gives_the_answers_of_single_rays) {
  using Real = TypeParam;
  const auto mesh = hard::icosphere<Real>(4);
  const auto rays = this->draw_rays(mesh);
  const auto scene = Scene<Real>::build(mesh.view());
  const Answers<Real> first(scene, rays, 1);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto hit = scene.closest_hit(rays[i]).value_or(Hit<Real>{});
    ASSERT_TRUE(show::same_bits(hit, first.closest[i])) << show::text(rays[i]);
    ASSERT_EQ(scene.any_hit(rays[i]) ? 1 : 0, first.any[i]) << show::text(rays[i]);
    std::vector<Hit<Real>> all;
    scene.all_hits(rays[i], all);
    ASSERT_TRUE(show::same_bits<Real>(all, first.all.of(i))) << show::text(rays[i]);
    hits += all.size();
  }
  EXPECT_GT(hits, rays.size() / 2);
  for (const unsigned threads : {0u, 2u, 3u, 8u}) {
    EXPECT_TRUE(first.same_as(Answers<Real>(scene, rays, threads))) << threads << " threads";
  }
  for (const Quality quality : {Quality::Fast, Quality::High, Quality::Compact}) {
    for (const unsigned threads : {1u, 2u}) {
      const BuildOptions options{.quality = quality, .work = {.threads = threads}};
      const auto other = Scene<Real>::build(mesh.view(), options);
      EXPECT_TRUE(first.same_as(Answers<Real>(other, rays, 2)))
          << "quality " << static_cast<int>(quality) << ", built by " << threads << " threads";
    }
  }
}

// Few rays take a way of their own, in every form of arrays; what they skip, do not see, or may be
// wrong in is the same there.
TYPED_TEST(Batches, few_rays_get_the_answers_of_many) {
  using Real = TypeParam;
  const auto mesh = hard::icosphere<Real>(2);
  const MeshView<Real> meshes[] = {mesh.view(), mesh.view()};
  const std::uint32_t scene_masks[] = {1, 2};
  const auto scene = Scene<Real>::build(std::span(meshes), {.masks = scene_masks});
  std::vector<Ray<Real>> rays = this->draw_rays(mesh);
  rays.resize(300);
  rays[7].direction = {0, 0, 0};
  std::vector<TriangleRef> skips(rays.size());
  std::vector<std::uint32_t> masks(rays.size());
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    skips[i] = {i % 2, i % 80};
    masks[i] = i % 4;
  }
  BatchOptions many{.range = Range::OpenStart,
                    .skip = skips,
                    .masks = masks,
                    .invalid = InvalidRays::Miss,
                    .work = {.threads = 1}};
  std::vector<Hit<Real>> all(rays.size());
  std::vector<std::uint8_t> all_any(rays.size());
  scene.closest_hits(rays, all, many);
  scene.any_hits(rays, all_any, many);
  for (std::size_t size = 0; size <= 20; ++size) {
    for (std::size_t first = 0; first + size <= rays.size(); first += 23) {
      BatchOptions few = many;
      few.skip = std::span(skips).subspan(first, size);
      few.masks = std::span(masks).subspan(first, size);
      const auto own = std::span<const Ray<Real>>(rays).subspan(first, size);
      std::vector<Hit<Real>> hits(size), in_rows(size);
      std::vector<std::uint8_t> any(size), any_in_rows(size);
      scene.closest_hits(own, hits, few);
      scene.any_hits(own, any, few);
      const auto arrays = RayArrays<Real>::of(own);
      scene.closest_hits(arrays, HitArrays<Real>{.hits = in_rows}, few);
      scene.any_hits(arrays, rows(std::span(any_in_rows)), few);
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_TRUE(show::same_bits(hits[i], all[first + i])) << show::text(own[i]);
        ASSERT_TRUE(show::same_bits(in_rows[i], all[first + i])) << show::text(own[i]);
        ASSERT_EQ(any[i], all_any[first + i]) << show::text(own[i]);
        ASSERT_EQ(any_in_rows[i], all_any[first + i]) << show::text(own[i]);
      }
      few.invalid = InvalidRays::Throw;
      if (first <= 7 && first + size > 7) {
        EXPECT_THROW(scene.closest_hits(own, hits, few), Error);
        EXPECT_THROW(scene.any_hits(own, any, few), Error);
      }
    }
  }
}

TYPED_TEST(Batches, the_order_of_the_rays_does_not_matter) {
  using Real = TypeParam;
  const auto mesh = hard::torus<Real>(48, 24);
  const auto rays = this->draw_rays(mesh);
  auto shuffled = rays;
  std::vector<std::size_t> from(rays.size());
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = i;
  Rng rng(hard::seed(), 10);
  for (std::size_t i = from.size(); i > 1; --i) std::swap(from[i - 1], from[rng.below(i)]);
  for (std::size_t i = 0; i < from.size(); ++i) shuffled[i] = rays[from[i]];
  const auto scene = Scene<Real>::build(mesh.view());
  const Answers<Real> straight(scene, rays, 2), mixed(scene, shuffled, 2);
  for (std::size_t i = 0; i < from.size(); ++i) {
    ASSERT_TRUE(show::same_bits(mixed.closest[i], straight.closest[from[i]]))
        << show::text(shuffled[i]);
    ASSERT_EQ(mixed.any[i], straight.any[from[i]]) << show::text(shuffled[i]);
    ASSERT_TRUE(show::same_bits<Real>(mixed.all.of(i), straight.all.of(from[i])))
        << show::text(shuffled[i]);
  }
}

// Cameras about a mesh that is not about the origin and whose coordinates have all their bits: they
// look at its corners too, from near and far, in steps of every size of direction, with a range for
// all or one each.
TYPED_TEST(Batches, cameras_anywhere_get_the_answers_of_single_rays) {
  using Real = TypeParam;
  const Vec3<Real> middle{Real(100.1), Real(-203.7), Real(31.9)};
  auto mesh = hard::icosphere<Real>(3);
  for (Vec3<Real>& p : mesh.vertices) {
    p = {middle.x + p.x * Real(0.73106), middle.y + p.y * Real(0.73106),
         middle.z + p.z * Real(0.73106)};
  }
  const auto scene = Scene<Real>::build(mesh.view());
  Rng rng(hard::seed(), 12);
  for (int camera = 0; camera < 60; ++camera) {
    const double away = rng.coin() ? 31 : 1.1 * std::ldexp(1.0, rng.between(0, 5));
    const double size = std::ldexp(1 + rng.unit(), rng.between(-30, 30));
    const double turn = 6.3 * rng.unit(), pixel = 0.02 * rng.unit();
    const bool corners = rng.coin(), ranges = rng.below(3) == 0;
    const Vec3<double> eye =
        predicate::to_double(Vec3<Real>{static_cast<Real>(away * std::cos(turn)) + middle.x,
                                        static_cast<Real>(away * std::sin(turn)) + middle.y,
                                        middle.z - static_cast<Real>(0.3 * away)});
    std::vector<Ray<Real>> rays(1 + rng.below(700));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Vec3<double> aim = predicate::to_double(middle);
      if (corners) {
        aim = predicate::to_double(mesh.vertices[mesh.triangles[i % 16][i % 3]]);
      } else {
        aim.x += pixel * static_cast<double>(i % 8);
        aim.z += pixel * static_cast<double>(i / 8 % 8);
      }
      rays[i].origin = {static_cast<Real>(eye.x), static_cast<Real>(eye.y),
                        static_cast<Real>(eye.z)};
      rays[i].direction = {static_cast<Real>((aim.x - eye.x) * size),
                           static_cast<Real>((aim.y - eye.y) * size),
                           static_cast<Real>((aim.z - eye.z) * size)};
      if (ranges) rays[i].t_max = static_cast<Real>(2 * away * rng.unit() / size);
    }
    std::vector<Hit<Real>> hits(rays.size());
    std::vector<std::uint8_t> any(rays.size());
    scene.closest_hits(rays, hits, {.work = {.threads = 1}});
    scene.any_hits(rays, any, {.work = {.threads = 1}});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto hit = scene.closest_hit(rays[i]);
      ASSERT_TRUE(show::same_bits(hit.value_or(Hit<Real>{}), hits[i])) << show::text(rays[i]);
      ASSERT_EQ(hit.has_value() ? 1 : 0, any[i]) << show::text(rays[i]);
    }
  }
}

// A rough field, and rays over it that start apart and run alike: packets of them come far, and
// each ray meets something else.
TYPED_TEST(Batches, rays_that_run_alike_and_part_get_the_answers_of_single_rays) {
  using Real = TypeParam;
  constexpr std::uint32_t kSide = 200, kRays = 4096;
  Rng rng(hard::seed(), 11);
  Mesh<Real> field;
  for (std::uint32_t i = 0; i <= kSide; ++i) {
    for (std::uint32_t k = 0; k <= kSide; ++k) {
      field.vertices.push_back({static_cast<Real>(i) / kSide, static_cast<Real>(k) / kSide,
                                static_cast<Real>(0.002 * rng.symmetric())});
      if (i == kSide || k == kSide) continue;
      const std::uint32_t a = i * (kSide + 1) + k, b = a + kSide + 1;
      field.triangles.push_back({a, b, a + 1});
      field.triangles.push_back({b, b + 1, a + 1});
    }
  }
  std::vector<Ray<Real>> rays;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const auto near = [&](double x, double reach) {
      return static_cast<Real>(x + reach * rng.symmetric());
    };
    rays.push_back({{near(0.3, 0.05), near(0.5, 0.05), near(0.01, 0.008)},
                    {near(1.5, 0.05), near(0.4, 0.05), near(-0.04, 0.03)}});
  }
  const auto scene = Scene<Real>::build(field.view());
  std::vector<Hit<Real>> hits(kRays);
  std::vector<std::uint8_t> any(kRays);
  Statistics closest_work, any_work;
  scene.closest_hits(rays, hits, {.work = {.threads = 1, .statistics = &closest_work}});
  scene.any_hits(rays, any, {.work = {.threads = 1, .statistics = &any_work}});
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const auto hit = scene.closest_hit(rays[i]);
    ASSERT_TRUE(show::same_bits(hit.value_or(Hit<Real>{}), hits[i])) << show::text(rays[i]);
    ASSERT_EQ(hit.has_value() ? 1 : 0, any[i]) << show::text(rays[i]);
  }
  EXPECT_GT(closest_work.hits, kRays / 4);
  EXPECT_LT(any_work.hits, kRays);
  // More than 64 steps a packet, after which its rays are looked at one by one.
  EXPECT_GT(closest_work.nodes + closest_work.leaves, kRays);
}

// Coherent rays in double that start just before a slope of which all coordinates are floats, on
// it, or just behind it: as floats some of them would start on the other side.
TEST(BatchesInDouble, rays_that_are_no_floats_start_where_they_start) {
  Mesh<double> slope;
  constexpr double kSmall = 0x1p-14, kX = 0.6875, kY = 0.1875;
  const auto add = [&](const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c) {
    const auto first = static_cast<std::uint32_t>(slope.vertices.size());
    slope.vertices.insert(slope.vertices.end(), {a, b, c});
    slope.triangles.push_back({first, first + 1, first + 2});
  };
  const auto up = [](double x, double y) { return Vec3<double>{x, y, (x + y) / 2}; };
  for (int i = 0; i < 12; ++i) {  // so many that large ones do not lie in the same leaf
    const double x = kX + 4 * i * kSmall;
    add(up(x, kY), up(x + kSmall, kY), up(x, kY + kSmall));
    add({-1, -1, -1}, {-1, 1, -1}, {i < 6 ? -1.0 : 1.0, 1, 1});
  }
  const auto scene = Scene<double>::build(slope.view());
  Rng rng(hard::seed(), 13);
  std::vector<Ray<double>> rays(256);
  std::vector<double> above(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // So that the middle of x and y is a double.
    const double x = kX + std::ldexp(static_cast<double>(1 + rng.below(1000)), -26);
    const double y = kY + std::ldexp(static_cast<double>(1 + rng.below(1000)), -27);
    const double middle = (x + y) / 2;
    const double z = middle + (i % 8 == 0 ? 0 : std::ldexp(rng.symmetric(), rng.between(-52, -27)));
    above[i] = z - middle;
    rays[i] = {{x, y, z}, {0.001, 0.002, -1}};
    rays[i].t_max = 0x1p-10;
  }
  std::vector<Hit<double>> hits(rays.size());
  std::vector<std::uint8_t> any(rays.size());
  scene.closest_hits(rays, hits, {.work = {.threads = 1}});
  scene.any_hits(rays, any, {.work = {.threads = 1}});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto hit = scene.closest_hit(rays[i]);
    ASSERT_EQ(hit.has_value(), above[i] >= 0) << show::text(rays[i]);
    ASSERT_EQ(any[i], above[i] >= 0 ? 1 : 0) << show::text(rays[i]);
    ASSERT_TRUE(show::same_bits(hit.value_or(Hit<double>{}), hits[i])) << show::text(rays[i]);
  }
}

}  // namespace
}  // namespace pierce
