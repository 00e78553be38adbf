// SPDX-License-Identifier: Apache-2.0
//
// Scene against the brute-force exact oracle, bit by bit: closest, any and all hits, single and in
// batches, with 1 and 2 threads, OpenStart and skip, on soups of every style of number and on
// regular meshes. PIERCE_CASES=100000 makes the first test look at that many soups.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/compare_scene.h"
#include "support/outliers.h"
#include "support/run_cases.h"
#include "support/save_failure.h"

namespace pierce {
namespace {

using hard::AimedRay;
using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class SceneAgainstOracle : public testing::Test {
 public:
  static std::vector<AimedRay<Real>> aim(Rng& rng, const Mesh<Real>& mesh, Style style, int rays) {
    std::vector<AimedRay<Real>> aimed;
    for (int i = 0; i < rays; ++i) aimed.push_back(hard::aimed_ray(rng, mesh, style));
    return aimed;
  }

  static void expect_exact(const char* name, const Mesh<Real>& mesh, Style style, int rays) {
    Rng rng(hard::seed(), 77);
    const auto aimed = aim(rng, mesh, style, rays);
    for (const Quality quality : {Quality::Balanced, Quality::Compact}) {
      const auto found = oracle::difference(mesh, aimed, {.quality = quality});
      EXPECT_FALSE(found) << name << ", seed " << hard::seed() << ", quality "
                          << static_cast<int>(quality) << "\n"
                          << *found;
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SceneAgainstOracle, Reals);

TYPED_TEST(SceneAgainstOracle, soups_of_every_style_are_answered_exactly) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(70); ++i) {
    Rng rng(hard::seed(), i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    const auto triangles = static_cast<std::uint32_t>(1 + rng.below(rng.one_in(10) ? 300 : 40));
    Mesh<Real> mesh = hard::soup<Real>(rng, style, triangles);
    if (rng.one_in(3)) mesh = hard::copies(rng, mesh, 1 + rng.between(1, 3));
    const BuildOptions options{.quality = static_cast<Quality>(rng.below(4))};
    const auto found = oracle::difference(mesh, this->aim(rng, mesh, style, 12), options);
    ASSERT_FALSE(found) << "seed " << hard::seed() << " soup " << i << " quality "
                        << static_cast<int>(options.quality) << "\n"
                        << *found;
  }
}

TYPED_TEST(SceneAgainstOracle, regular_meshes_are_answered_exactly) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 0);
  this->expect_exact("icosphere", hard::icosphere<Real>(3), Style::Unit, 60);
  this->expect_exact("lattice cube", hard::lattice_cube<Real>(8), Style::SmallInteger, 60);
  this->expect_exact("voxels", hard::random_voxels<Real>(rng, 6), Style::SmallInteger, 60);
  this->expect_exact("torus", hard::torus<Real>(40, 20), Style::Unit, 60);
  this->expect_exact("terrain", hard::terrain<Real>(rng, 40), Style::Unit, 60);
  this->expect_exact("needles", hard::needles<Real>(rng, 400), Style::Unit, 60);
}

TYPED_TEST(SceneAgainstOracle, detail_beside_something_huge_is_answered_exactly) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(60); ++i) {
    Rng rng(hard::seed() + 15, i);
    const Style style = rng.coin() ? Style::Unit : hard::kAllStyles[i % hard::kAllStyles.size()];
    Mesh<Real> mesh = rng.one_in(3) ? hard::terrain<Real>(rng, 12)
                      : rng.coin()  ? hard::icosphere<Real>(1)
                                    : hard::soup<Real>(rng, style, 30);
    const auto aimed = this->aim(rng, mesh, style, 12);  // at the detail
    hard::add_outlier(rng, mesh);
    auto all = this->aim(rng, mesh, style, 4);
    all.insert(all.end(), aimed.begin(), aimed.end());
    const BuildOptions options{.quality = static_cast<Quality>(rng.below(4))};
    const auto found = oracle::difference(mesh, all, options);
    ASSERT_FALSE(found) << "seed " << hard::seed() << " mesh " << i << "\n" << *found;
  }
}

TYPED_TEST(SceneAgainstOracle, coincident_triangles_are_all_found_in_order) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 1);
  const Mesh<Real> one{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 1}}, {{0, 1, 2}, {1, 3, 2}}};
  this->expect_exact("copies", hard::copies(rng, one, 300), Style::Lattice, 25);
  this->expect_exact("copied ball", hard::copies(rng, hard::icosphere<Real>(1), 9), Style::Unit,
                     30);
}

// Layers so near each other that their floats all but coincide, in t and in place.
TYPED_TEST(SceneAgainstOracle, surfaces_a_hair_apart_are_told_apart) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 2);
  for (const int apart : {18, 22, 24, 30, 45}) {
    const auto ball = hard::icosphere<Real>(2);
    auto layers = ball;
    for (int layer = 0; layer < 4; ++layer) {
      const auto first = static_cast<std::uint32_t>(layers.vertices.size());
      for (const auto& v : ball.vertices) {
        const auto moved = [&](Real x) {
          return x + std::ldexp(static_cast<Real>(rng.symmetric()), -apart);
        };
        layers.add({moved(v.x), moved(v.y), moved(v.z)});
      }
      for (const auto& [a, b, c] : ball.triangles) {
        layers.triangles.push_back({a + first, b + first, c + first});
      }
    }
    this->expect_exact("layers", layers, Style::Unit, 50);
  }
}

TYPED_TEST(SceneAgainstOracle, several_geometries_are_one_scene) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < 30; ++i) {
    Rng rng(hard::seed(), 1000 + i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    std::vector<Mesh<Real>> meshes;
    for (int k = rng.between(1, 5); k >= 0; --k) {
      const auto triangles = static_cast<std::uint32_t>(rng.one_in(4) ? 0 : rng.between(1, 30));
      meshes.push_back(hard::soup<Real>(rng, style, triangles));
    }
    meshes.push_back(meshes.front());  // geometries that coincide
    meshes.push_back(hard::soup<Real>(rng, style, 5));
    std::vector<MeshView<Real>> views;
    for (const auto& mesh : meshes) views.push_back(mesh.view());
    const auto scene = Scene<Real>::build(views, {.quality = static_cast<Quality>(i % 4)});
    const oracle::BruteForce<Real> truth(views);

    std::vector<Ray<Real>> rays;
    std::vector<TriangleRef> skip;
    std::vector<std::vector<Hit<Real>>> plain, skipping;
    for (int k = 0; k < 30; ++k) {
      const auto geometry = rng.below(meshes.size());
      if (meshes[geometry].triangles.empty()) continue;
      const auto aimed = hard::aimed_ray(rng, meshes[geometry], style);
      rays.push_back(aimed.ray);
      plain.push_back(truth.all_hits(aimed.ray));
      skip.push_back({static_cast<std::uint32_t>(geometry), aimed.triangle});
      skipping.push_back(truth.all_hits(aimed.ray, Range::Closed, skip.back()));
      const auto found = oracle::difference_on_one_ray(scene, truth, aimed.ray);
      ASSERT_FALSE(found) << "seed " << hard::seed() << " scene " << i << show::text(aimed.ray)
                          << *found;
    }
    auto found = oracle::difference_on_batch<Real>(scene, rays, plain, {.work = {.threads = 2}});
    ASSERT_FALSE(found) << "seed " << hard::seed() << " scene " << i << " " << *found;
    found = oracle::difference_on_batch<Real>(scene, rays, skipping, {.skip = skip});
    ASSERT_FALSE(found) << "seed " << hard::seed() << " scene " << i << " " << *found;
  }
}

// Two triangles whose hits lie at the same t, or as near as rounding can bring them.
TYPED_TEST(SceneAgainstOracle, two_hits_are_put_in_order_exactly) {
  using Real = TypeParam;
  int pairs = 0, same_t = 0;
  for (std::uint64_t i = 0; i < hard::case_count(8000); ++i) {
    Rng rng(hard::seed(), 2000 + i);
    hard::Case<Real> c = hard::hard_case<Real>(rng);
    const oracle::LineAndTriangle first(c.ray, c.a, c.b, c.c);
    if (!first.line_hits()) continue;
    Mesh<Real> mesh{{c.a, c.b, c.c}, {{0, 1, 2}}};
    if (rng.coin()) {  // shares an edge or a vertex, or is the same but for some ulps
      for (int moved = rng.between(0, 3); moved > 0; --moved) {
        Vec3<Real>& v = rng.coin() ? c.a : rng.coin() ? c.b : c.c;
        Real& x = hard::component(v, rng.below(3));
        x = rng.coin() ? hard::nudged(x, rng.between(-2, 2)) : hard::vec<Real>(rng, Style::Unit).x;
      }
    } else {  // any triangle around the hit point, moved along the ray
      const Real t = oracle::round_ratio<Real>(first.hit_numbers().t_num, first.hit_numbers().den);
      if (!std::isfinite(t)) continue;
      const auto p =
          oracle::exact(c.ray.origin) + oracle::Dyadic(t) * oracle::exact(c.ray.direction);
      const auto u = oracle::exact(hard::vec<Real>(rng, Style::SmallInteger));
      const auto v = oracle::exact(hard::vec<Real>(rng, Style::SmallInteger));
      const oracle::Dyadic s(mpz_class(1), -rng.between(0, 20));
      c.a = hard::rounded_point<Real>(p + s * u);
      c.b = hard::rounded_point<Real>(p + s * v);
      c.c = hard::rounded_point<Real>(p - s * (u + v));
    }
    if (!hard::is_finite(c.a) || !hard::is_finite(c.b) || !hard::is_finite(c.c)) continue;
    mesh.vertices.insert(mesh.vertices.end(), {c.a, c.b, c.c});
    mesh.triangles.push_back({3, 4, 5});
    if (rng.coin()) std::swap(mesh.triangles[0], mesh.triangles[1]);
    const oracle::LineAndTriangle second(c.ray, c.a, c.b, c.c);
    if (second.line_hits()) {
      ++pairs;
      same_t += compare_t(first.hit_numbers(), second.hit_numbers()) == 0 ? 1 : 0;
    }
    const auto on_pair = [](const Mesh<Real>& m, const Ray<Real>& r) {
      return oracle::difference_on_one_ray(Scene<Real>::build(m.view()),
                                           oracle::BruteForce<Real>(m.view()), r);
    };
    if (on_pair(mesh, c.ray)) {
      hard::shrink(mesh, c.ray,
                   [&](const auto& m, const auto& r) { return on_pair(m, r).has_value(); });
      FAIL() << "seed " << hard::seed() << " pair " << i << *on_pair(mesh, c.ray) << "\n"
             << hard::saved(show::text(c.ray) + "\n" + show::text(mesh));
    }
  }
  if (hard::enough_cases(8000)) {
    EXPECT_GT(pairs, 100);
    EXPECT_GT(same_t, 50);
  }
}

// Components so small that the transform into filter space rounds them after all, although powers
// of two are all that it multiplies by.
TYPED_TEST(SceneAgainstOracle, rays_next_to_a_corner_at_zero_and_nearly_along_axes_are_exact) {
  using Real = TypeParam;
  constexpr int kLeast =
      std::numeric_limits<Real>::min_exponent - std::numeric_limits<Real>::digits;
  int hits = 0;
  for (std::uint64_t i = 0; i < hard::case_count(200); ++i) {
    Rng rng(hard::seed(), i);
    const auto large = [&] { return static_cast<Real>(1000 * rng.symmetric()); };
    const auto least = [&] {
      return static_cast<Real>(std::ldexp(rng.symmetric(), kLeast + rng.between(0, 20)));
    };
    Mesh<Real> mesh;
    const auto zero = mesh.add({0, 0, 0});
    for (int k = 0; k < 4; ++k) {
      const auto b = mesh.add({large(), large(), large()});
      mesh.triangles.push_back({zero, b, mesh.add({large(), large(), large()})});
    }
    const auto scene = Scene<Real>::build(mesh.view());
    const oracle::BruteForce<Real> truth(mesh.view());
    for (int k = 0; k < 10; ++k) {
      const int size = -rng.between(0, -kLeast - 40);
      const auto component = [&] { return static_cast<Real>(std::ldexp(rng.symmetric(), size)); };
      Ray<Real> ray{{least(), least(), least()}, {component(), component(), component()}};
      if (rng.coin()) {  // between a corner and an edge, beside them
        const auto& t = mesh.vertices[1 + rng.below(8)];
        const Real w = static_cast<Real>(std::ldexp(rng.unit(), -rng.between(0, 60)));
        ray.origin = {t.x * w, t.y * w, t.z * w};
      }
      if (rng.one_in(3)) (rng.coin() ? ray.direction.x : ray.direction.z) = least();
      if (rng.coin()) ray.t_min = -std::numeric_limits<Real>::infinity();
      const auto found = oracle::difference_on_one_ray(scene, truth, ray);
      ASSERT_FALSE(found) << "seed " << hard::seed() << " case " << i << "\n" << *found;
      hits += scene.any_hit(ray) ? 1 : 0;
    }
  }
  if (hard::enough_cases(200)) {
    EXPECT_GT(hits, 200);
  }
}

TYPED_TEST(SceneAgainstOracle, a_scene_without_triangles_is_never_hit) {
  using Real = TypeParam;
  const auto scene = Scene<Real>::build(std::span<const MeshView<Real>>{});
  const Ray<Real> ray{{0, 0, 0}, {0, 0, 1}};
  const Mesh<Real> empty{{{1, 2, 3}}, {}};
  EXPECT_FALSE(oracle::difference_on_one_ray(scene, oracle::BruteForce<Real>(empty.view()), ray));
  const auto other = Scene<Real>::build(empty.view());
  EXPECT_FALSE(oracle::difference_on_one_ray(other, oracle::BruteForce<Real>(empty.view()), ray));
  const std::vector<Ray<Real>> rays(3, ray);
  const std::vector<std::vector<Hit<Real>>> none(3);
  EXPECT_FALSE(oracle::difference_on_batch<Real>(other, rays, none, {}));
}

TYPED_TEST(SceneAgainstOracle, vertices_that_no_triangle_uses_do_not_matter) {
  using Real = TypeParam;
  auto mesh = hard::icosphere<Real>(1);
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  mesh.add({nan, std::numeric_limits<Real>::infinity(), 0});
  mesh.add({std::numeric_limits<Real>::max(), 0, 0});
  this->expect_exact("unused vertices", mesh, Style::Unit, 20);
}

TYPED_TEST(SceneAgainstOracle, a_batch_without_rays_is_welcome) {
  using Real = TypeParam;
  const auto mesh = hard::icosphere<Real>(0);
  const auto scene = Scene<Real>::build(mesh.view());
  EXPECT_FALSE(oracle::difference_on_batch<Real>(scene, {}, {}, {}));
}

}  // namespace
}  // namespace pierce
