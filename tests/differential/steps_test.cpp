// SPDX-License-Identifier: Apache-2.0
//
// after, distinct, filter and invalid, together with all the other options, against the oracle:
// soups of every style of number, copies of themselves, aimed at edges and vertices. The filter
// notes what it is asked, which must be what it has to be asked, in that order.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/compare_scene.h"
#include "support/run_cases.h"
#include "support/step_truth.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

constexpr std::array<std::uint32_t, 5> kMasks = {kAllBits, kAllBits, 1, 3, 2};

/// Accepts one triangle in `one_in`, always the same ones.
struct Picky {
  std::uint32_t salt, one_in;
  bool operator()(std::uint64_t, const Hit<double>& hit) const {
    return ((hit.triangle * 2654435761U) ^ (hit.geometry * 40503U) ^ salt) / 7 % one_in == 0;
  }
};

Hit<double> in_double(const Hit<float>& h) {
  return {h.t, h.u, h.v, h.w, h.geometry, h.triangle, h.facing};
}
Hit<double> in_double(const Hit<double>& h) { return h; }

template <class Real>
struct World {
  std::vector<Mesh<Real>> meshes;
  std::vector<MeshView<Real>> views;
  std::vector<std::uint32_t> masks;

  static World draw(Rng& rng, Style style) {
    World world;
    for (int k = rng.between(1, 3); k > 0; --k) {
      auto mesh = hard::soup<Real>(rng, style, static_cast<std::uint32_t>(rng.between(1, 16)));
      world.meshes.push_back(hard::copies(rng, mesh, rng.between(1, 3)));
    }
    world.meshes.push_back(world.meshes.front());
    for (const auto& mesh : world.meshes) {
      world.views.push_back(mesh.view());
      world.masks.push_back(rng.pick(kMasks));
    }
    return world;
  }
};

QueryOptions draw_options(Rng& rng, TriangleRef aimed_at, const std::vector<TriangleRef>& line) {
  QueryOptions options;
  options.range = rng.coin() ? Range::Closed : Range::OpenStart;
  if (rng.one_in(4)) options.skip = aimed_at;
  if (rng.one_in(3)) options.sides = rng.pick(std::array{Sides::Front, Sides::Back});
  options.mask = rng.pick(kMasks);
  if (rng.one_in(3)) options.max_hits = rng.below(4);
  if (rng.coin() && !line.empty()) options.after = line[rng.below(line.size())];
  options.distinct = rng.coin();
  if (rng.coin()) {
    options.filter = Picky{static_cast<std::uint32_t>(rng.below(1000)),
                           static_cast<std::uint32_t>(rng.between(1, 5))};
  }
  return options;
}

std::string text(const QueryOptions& o) {
  return show::joined(" range ", static_cast<int>(o.range), " skip ", o.skip.geometry, ':',
                      o.skip.triangle, " sides ", static_cast<int>(o.sides), " mask ", o.mask,
                      " max_hits ", o.max_hits, " after ", o.after.geometry, ':', o.after.triangle,
                      o.distinct ? " distinct" : "", o.filter ? " filter" : "");
}

template <class Real>
class StepsAgainstOracle : public testing::Test {
 public:
  using Truth = oracle::StepTruth<Real>;

  static void expect_single(const Scene<Real>& scene, const Truth& truth, const Ray<Real>& ray,
                            QueryOptions options) {
    const std::string about = show::text(ray) + text(options);
    const auto first = truth.answer(options, 1);
    const auto all = truth.answer(options, options.max_hits);
    const auto counted = truth.answer(options, kUnlimited);
    std::vector<Hit<double>> asked;
    if (options.filter) {
      options.filter = [&asked, inner = options.filter](std::uint64_t i, const Hit<double>& hit) {
        EXPECT_EQ(i, 0U);
        asked.push_back(hit);
        return inner(i, hit);
      };
    }
    const auto expect_asked = [&](const std::vector<Hit<Real>>& wanted) {
      std::vector<Hit<double>> wide;
      for (const auto& hit : wanted) wide.push_back(in_double(hit));
      ASSERT_TRUE(show::same_bits<double>(asked, wide)) << about << show::text<double>(asked);
      asked.clear();
    };
    const Hit<Real> expected = first.hits.empty() ? Hit<Real>{} : first.hits[0];
    const auto closest = scene.closest_hit(ray, options).value_or(Hit<Real>{});
    ASSERT_TRUE(show::same_bits(closest, expected)) << about << show::text(closest);
    expect_asked(first.asked);
    ASSERT_EQ(scene.any_hit(ray, options), !first.hits.empty()) << about;
    expect_asked(first.asked);
    std::vector<Hit<Real>> hits(1);
    scene.all_hits(ray, hits, options);
    ASSERT_TRUE(show::same_bits<Real>(hits, all.hits)) << about << show::text<Real>(hits);
    expect_asked(all.asked);
    ASSERT_EQ(scene.count_hits(ray, options), counted.hits.size()) << about;
    expect_asked(counted.asked);
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(StepsAgainstOracle, Reals);

TYPED_TEST(StepsAgainstOracle, single_rays) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(60); ++i) {
    Rng rng(hard::seed(), 7000 + i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    const auto world = World<Real>::draw(rng, style);
    const BuildOptions build{.quality = static_cast<Quality>(rng.below(4)), .masks = world.masks};
    const auto scene = Scene<Real>::build(world.views, build);
    for (int k = 0; k < 8; ++k) {
      const auto geometry = static_cast<std::uint32_t>(rng.below(world.meshes.size()));
      const auto aimed = hard::aimed_ray(rng, world.meshes[geometry], style);
      const oracle::StepTruth<Real> truth(world.views, world.masks, aimed.ray);
      for (int o = 0; o < 6; ++o) {
        const auto options = draw_options(rng, {geometry, aimed.triangle}, truth.on_line());
        this->expect_single(scene, truth, aimed.ray, options);
        if (testing::Test::HasFatalFailure()) FAIL() << "scene " << i;
      }
    }
  }
}

TYPED_TEST(StepsAgainstOracle, batches_with_bad_rays_among_them) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  for (std::uint64_t i = 0; i < hard::case_count(10); ++i) {
    Rng rng(hard::seed(), 9000 + i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    const auto world = World<Real>::draw(rng, style);
    const auto scene = Scene<Real>::build(
        world.views, {.quality = static_cast<Quality>(rng.below(4)), .masks = world.masks});
    std::vector<Ray<Real>> rays;
    std::vector<TriangleRef> after, none;
    std::vector<std::vector<Hit<Real>>> closest_of, lists_of, counted_of;
    const QueryOptions drawn = draw_options(rng, {}, {});
    const bool with_after = rng.coin();
    for (int k = 0; k < 40; ++k) {
      const auto& mesh = world.meshes[rng.below(world.meshes.size())];
      const auto aimed = hard::aimed_ray(rng, mesh, style);
      const oracle::StepTruth<Real> truth(world.views, world.masks, aimed.ray);
      const auto line = truth.on_line();
      for (int copies = rng.coin() ? 16 : 1; copies > 0; --copies) {
        const bool bad = rng.one_in(8);
        rays.push_back(aimed.ray);
        QueryOptions one = drawn;
        if (with_after && rng.coin() && !line.empty()) one.after = line[rng.below(line.size())];
        after.push_back(one.after);
        if (bad) rays.back().direction.y = nan;
        if (bad && rng.coin()) rays.back().direction = {0, -Real(0), 0};
        const auto hits = [&](std::uint64_t most) {
          return bad ? std::vector<Hit<Real>>{} : truth.answer(one, most).hits;
        };
        closest_of.push_back(hits(1));
        lists_of.push_back(hits(drawn.max_hits));
        counted_of.push_back(hits(kUnlimited));
      }
    }
    const BatchOptions options{.range = drawn.range,
                               .sides = drawn.sides,
                               .mask = drawn.mask,
                               .max_hits = drawn.max_hits,
                               .after = with_after ? after : none,
                               .distinct = drawn.distinct,
                               .invalid = InvalidRays::Miss,
                               .filter = drawn.filter,
                               .work = {.threads = static_cast<unsigned>(1 + rng.below(2))}};
    std::vector<Hit<Real>> closest(rays.size(), Hit<Real>{7, 7, 7, 7, 7, 7, Facing::Back});
    std::vector<std::uint8_t> any(rays.size(), 7);
    std::vector<std::uint32_t> counts(rays.size(), 7);
    scene.closest_hits(rays, closest, options);
    scene.any_hits(rays, any, options);
    scene.count_hits(rays, counts, options);
    const auto lists = scene.all_hits(rays, options);
    std::vector<Hit<Real>> streamed;
    scene.all_hits(rays, options, [&](std::uint64_t, const HitLists<Real>& piece) {
      streamed.insert(streamed.end(), piece.hits.begin(), piece.hits.end());
    });
    ASSERT_TRUE(show::same_bits<Real>(streamed, lists.hits)) << "scene " << i;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::string about =
          show::joined("scene ", i, " ray ", k, ' ', show::text(rays[k]), text(drawn));
      const Hit<Real> first = closest_of[k].empty() ? Hit<Real>{} : closest_of[k][0];
      ASSERT_TRUE(show::same_bits(closest[k], first)) << about << show::text(closest[k]);
      ASSERT_EQ(any[k], closest_of[k].empty() ? 0 : 1) << about;
      ASSERT_EQ(counts[k], counted_of[k].size()) << about;
      ASSERT_TRUE(show::same_bits<Real>(lists.of(k), lists_of[k])) << about;
    }
  }
}

// A pile of layers, most of them doubled, some with three hundred triangles at one place; a large
// triangle that High cuts into several leaves among small ones.
template <class Real>
Mesh<Real> pile(Rng& rng) {
  Mesh<Real> mesh;
  const auto layer = [&](Real z, Real size) {
    const auto a = mesh.add({-size, -size, z});
    mesh.add({size, -size, z});
    mesh.add({0, size, z});
    return a;
  };
  for (int i = 0; i < 60; ++i) {
    const Real z = i % 9 == 0 ? std::nextafter(Real(i), Real(99)) : Real(i);
    const auto a = layer(z, rng.one_in(5) ? Real(1000) : Real(1));
    const int copies = i == 20 || i == 41 ? 300 : rng.between(1, 2);
    for (int k = 0; k < copies; ++k) {
      mesh.triangles.push_back(rng.coin() ? Triangle{a, a + 1, a + 2} : Triangle{a + 1, a, a + 2});
    }
  }
  // Steep ones that run through all layers, and small ones that make High cut them.
  for (int k = 0; k < 4; ++k) {
    const auto a = mesh.add({Real(-0.5), Real(-0.25), -3});
    mesh.add({Real(0.5), Real(0.125) * static_cast<Real>(k), 70});
    mesh.add({Real(0.25), 1, 70});
    mesh.triangles.push_back({a, a + 1, a + 2});
  }
  for (int k = 0; k < 400; ++k) {
    const auto a = mesh.add({static_cast<Real>(rng.unit()), static_cast<Real>(rng.unit()),
                             static_cast<Real>(60 * rng.unit())});
    const auto v = mesh.vertices[a];
    mesh.add({v.x + Real(0.01), v.y, v.z});
    mesh.add({v.x, v.y + Real(0.01), v.z});
    mesh.triangles.push_back({a, a + 1, a + 2});
  }
  return mesh;
}

TYPED_TEST(StepsAgainstOracle, stepping_goes_through_all_hits_and_loses_none) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 77);
  const auto mesh = pile<Real>(rng);
  for (const Quality quality :
       {Quality::Fast, Quality::Balanced, Quality::High, Quality::Compact}) {
    const auto scene = Scene<Real>::build(mesh.view(), {.quality = quality});
    for (const Ray<Real>& ray : {Ray<Real>{{0, 0, -1}, {0, 0, 1}},
                                 Ray<Real>{{Real(0.125), Real(0.25), 80}, {Real(0.001), 0, -1}}}) {
      std::vector<Hit<Real>> all, stepped, distinct, stepped_distinct;
      scene.all_hits(ray, all);
      ASSERT_GT(all.size(), 650U);
      Hit<Real> last;
      while (const auto hit = scene.closest_hit(ray, {.after = last})) {
        stepped.push_back(last = *hit);
        ASSERT_LE(stepped.size(), all.size());
      }
      EXPECT_TRUE(show::same_bits<Real>(stepped, all));
      scene.all_hits(ray, distinct, {.distinct = true});
      last = {};
      while (const auto hit = scene.closest_hit(ray, {.after = last, .distinct = true})) {
        stepped_distinct.push_back(last = *hit);
        ASSERT_LE(stepped_distinct.size(), distinct.size());
      }
      EXPECT_TRUE(show::same_bits<Real>(stepped_distinct, distinct));
      EXPECT_LT(distinct.size(), 70U);
      EXPECT_EQ(scene.count_hits(ray, {.distinct = true}), distinct.size());
      // The rest of the list after every 50th hit.
      for (std::size_t i = 0; i < all.size(); i += 50) {
        std::vector<Hit<Real>> rest;
        scene.all_hits(ray, rest, {.after = all[i]});
        EXPECT_TRUE(show::same_bits<Real>(rest, std::span(all).subspan(i + 1)));
        EXPECT_EQ(scene.count_hits(ray, {.after = all[i]}), rest.size());
        EXPECT_EQ(scene.any_hit(ray, {.after = all[i]}), !rest.empty());
      }
    }
  }
}

TYPED_TEST(StepsAgainstOracle, a_filter_is_asked_in_order_through_all_layers_of_a_pile) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 78);
  const auto mesh = pile<Real>(rng);
  const auto scene = Scene<Real>::build(mesh.view(), {.quality = Quality::High});
  const Ray<Real> ray{{0, 0, -1}, {0, 0, 1}};
  std::vector<Hit<Real>> all;
  scene.all_hits(ray, all);
  for (std::size_t wanted = 0; wanted <= all.size(); wanted += 7) {
    std::size_t asked = 0;
    const auto filter = [&](std::uint64_t, const Hit<double>& hit) {
      EXPECT_TRUE(show::same_bits(hit, in_double(all[asked])));
      return asked++ == wanted;
    };
    const auto hit = scene.closest_hit(ray, {.filter = filter});
    ASSERT_EQ(hit.has_value(), wanted < all.size());
    ASSERT_TRUE(!hit || show::same_bits(*hit, all[wanted]));
    EXPECT_EQ(asked, std::min(wanted + 1, all.size()));
  }
}

}  // namespace
}  // namespace pierce
