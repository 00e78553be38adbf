// SPDX-License-Identifier: Apache-2.0
//
// What must not change an answer, or must change it in a known way: the order of triangles, the
// order of corners, exact translations, scaling by powers of two, running the ray backwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
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
using Hits = std::vector<Hit<Real>>;

template <class Real>
Hits<Real> hits_of(const Mesh<Real>& mesh, const Ray<Real>& ray) {
  Hits<Real> hits;
  Scene<Real>::build(mesh.view()).all_hits(ray, hits);
  return hits;
}

template <class Real>
void sort_by_triangle(Hits<Real>& hits) {
  std::sort(hits.begin(), hits.end(),
            [](const auto& x, const auto& y) { return x.triangle < y.triangle; });
}

template <class Real>
class Invariance : public testing::Test {
 public:
  struct Draw {
    Mesh<Real> mesh;
    Ray<Real> ray;
  };

  static Draw draw(std::uint64_t i, bool tame) {
    Rng rng(hard::seed(), 3000 + i);
    const Style style = tame ? Style::Lattice : rng.pick(hard::kAllStyles);
    auto mesh = hard::soup<Real>(rng, style, static_cast<std::uint32_t>(rng.between(1, 30)));
    if (rng.coin()) mesh = hard::copies(rng, mesh, 2);
    return {mesh, hard::aimed_ray(rng, mesh, style).ray};
  }

  /// The hits of the changed mesh and ray, taken back by `restore`, must be those of the original.
  static void expect_same(const Draw& original, const Draw& changed,
                          const std::function<void(Hit<Real>&)>& restore, const char* what) {
    auto expected = hits_of(original.mesh, original.ray);
    auto found = hits_of(changed.mesh, changed.ray);
    for (auto& hit : found) restore(hit);
    sort_by_triangle(expected);
    sort_by_triangle(found);
    ASSERT_TRUE(show::same_bits<Real>(expected, found))
        << what << "\n"
        << show::text(original.ray) << "\n"
        << show::text(original.mesh) << "\nbefore:" << show::text<Real>(expected)
        << "\nafter: " << show::text<Real>(found);
    hits_seen += static_cast<int>(expected.size());
  }

  static void TearDownTestSuite() { EXPECT_GT(hits_seen, 1000); }

  inline static int hits_seen = 0;
  static constexpr std::uint64_t kDraws = 300;
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Invariance, Reals);

TYPED_TEST(Invariance, the_order_of_triangles_only_renumbers_them) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < this->kDraws; ++i) {
    const auto original = this->draw(i, false);
    auto changed = original;
    const auto count = static_cast<std::uint32_t>(original.mesh.triangles.size());
    std::vector<std::uint32_t> from(count);
    Rng rng(hard::seed(), i);
    for (std::uint32_t k = 0; k < count; ++k) from[k] = k;
    for (std::uint32_t k = count; k > 1; --k) std::swap(from[k - 1], from[rng.below(k)]);
    for (std::uint32_t k = 0; k < count; ++k) {
      changed.mesh.triangles[k] = original.mesh.triangles[from[k]];
    }
    this->expect_same(
        original, changed, [&](Hit<Real>& h) { h.triangle = from[h.triangle]; },
        "order of triangles");
  }
}

TYPED_TEST(Invariance, rotating_the_corners_rotates_the_weights) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < this->kDraws; ++i) {
    const auto original = this->draw(i, false);
    auto changed = original;
    for (auto& [a, b, c] : changed.mesh.triangles) std::tie(a, b, c) = std::tuple(b, c, a);
    this->expect_same(
        original, changed,
        [](Hit<Real>& h) { std::tie(h.u, h.v, h.w) = std::tuple(h.w, h.u, h.v); }, "rotation");
  }
}

TYPED_TEST(Invariance, reversing_the_corners_flips_the_facing) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < this->kDraws; ++i) {
    const auto original = this->draw(i, false);
    auto changed = original;
    for (auto& [a, b, c] : changed.mesh.triangles) std::swap(b, c);
    this->expect_same(
        original, changed,
        [](Hit<Real>& h) {
          std::swap(h.u, h.v);
          h.facing = h.facing == Facing::Front ? Facing::Back : Facing::Front;
        },
        "reversal");
  }
}

TYPED_TEST(Invariance, an_exact_translation_changes_nothing) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < this->kDraws; ++i) {
    const auto lattice = this->draw(i, true);
    auto original = lattice;
    // Only what is a multiple of 1/8 well below 2^17 is moved exactly, in float too.
    auto& o = original.ray.origin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Real& x = hard::component(o, axis);
      x = std::round(std::clamp(x, Real(-100), Real(100)) * 8) / 8;
    }
    auto changed = original;
    const auto moved = [](Vec3<Real>& v) { v = {v.x + 65536, v.y - 4096, v.z + Real(3000.5)}; };
    for (auto& v : changed.mesh.vertices) moved(v);
    moved(changed.ray.origin);
    this->expect_same(
        original, changed, [](Hit<Real>&) {}, "translation");
  }
}

TYPED_TEST(Invariance, scaling_by_a_power_of_two_scales_t_alone) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < this->kDraws; ++i) {
    Rng rng(hard::seed(), i);
    const auto original = this->draw(i, true);
    auto changed = original;
    const int points = rng.between(-60, 60), direction = rng.between(-40, 40);
    const auto scale = [](Vec3<Real>& v, int by) {
      v = {std::ldexp(v.x, by), std::ldexp(v.y, by), std::ldexp(v.z, by)};
    };
    for (auto& v : changed.mesh.vertices) scale(v, points);
    scale(changed.ray.origin, points);
    scale(changed.ray.direction, direction);
    for (Real* t : {&changed.ray.t_min, &changed.ray.t_max}) {
      *t = std::ldexp(*t, points - direction);
    }
    // A number that under- or overflowed was not scaled exactly.
    const auto back = [&](const Vec3<Real>& v, const Vec3<Real>& of, int by) {
      Vec3<Real> w = v;
      scale(w, -by);
      return w == of;
    };
    if (!back(changed.ray.direction, original.ray.direction, direction) ||
        !back(changed.ray.origin, original.ray.origin, points) ||
        std::ldexp(changed.ray.t_min, direction - points) != original.ray.t_min ||
        std::ldexp(changed.ray.t_max, direction - points) != original.ray.t_max) {
      continue;
    }
    auto hits = hits_of(changed.mesh, changed.ray);
    if (std::any_of(hits.begin(), hits.end(),
                    [](const auto& h) { return h.t != 0 && !std::isnormal(h.t); })) {
      continue;
    }
    this->expect_same(
        original, changed, [&](Hit<Real>& h) { h.t = std::ldexp(h.t, direction - points); },
        "scaling");
  }
}

// One by one, down to where components are subnormal.
TYPED_TEST(Invariance, however_small_the_direction_a_ray_hits_the_same) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 77);
  const auto mesh = hard::soup<Real>(rng, Style::Lattice, 200);
  const auto scene = Scene<Real>::build(mesh.view());
  constexpr int kLeast = std::numeric_limits<Real>::min_exponent;
  int hits = 0, subnormal = 0;
  for (int i = 0; i < 20000; ++i) {
    // To somewhere in a triangle, all but along an axis: the other components are subnormal first.
    Vec3<Real> direction;
    for (Real* c : {&direction.x, &direction.y, &direction.z}) {
      *c = std::ldexp(static_cast<Real>(rng.between(-8, 8)), -rng.between(4, 9));
    }
    (&direction.x)[rng.below(3)] = static_cast<Real>(rng.coin() ? 32 : -37);
    const Triangle& t = mesh.triangles[rng.below(mesh.triangles.size())];
    const auto from = [&](Real Vec3<Real>::*axis) {
      const Real target = (mesh.vertices[t[0]].*axis + mesh.vertices[t[1]].*axis) / 4 +
                          mesh.vertices[t[2]].*axis / 2;
      return target - direction.*axis * static_cast<Real>(rng.between(1, 32)) / 16;
    };
    const Ray<Real> ray{{from(&Vec3<Real>::x), from(&Vec3<Real>::y), from(&Vec3<Real>::z)},
                        direction};
    const auto expected = scene.closest_hit(ray);
    const int by = rng.between(kLeast + 1, rng.coin() ? kLeast + 6 : 0);
    auto small = ray;
    for (Real* c : {&small.direction.x, &small.direction.y, &small.direction.z}) {
      *c = std::ldexp(*c, by);
      subnormal += *c != 0 && !std::isnormal(*c) ? 1 : 0;
    }
    const auto found = scene.closest_hit(small);
    ASSERT_EQ(expected.has_value(), scene.any_hit(small)) << show::text(small);
    ASSERT_EQ(expected.has_value(), found.has_value()) << show::text(small);
    if (!found) continue;
    ++hits;
    auto there = *expected;
    there.t = std::ldexp(there.t, -by);
    if (!std::isnormal(expected->t) || !std::isnormal(there.t)) continue;
    ASSERT_TRUE(show::same_bits<Real>({there}, {*found})) << show::text(small);
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(subnormal, 100);
}

TYPED_TEST(Invariance, a_ray_run_backwards_has_its_hits_at_minus_t) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < this->kDraws; ++i) {
    const auto original = this->draw(i, false);
    auto changed = original;
    auto& ray = changed.ray;
    ray.direction = {-ray.direction.x, -ray.direction.y, -ray.direction.z};
    ray.t_min = -original.ray.t_max;
    ray.t_max = -original.ray.t_min;
    this->expect_same(
        original, changed,
        [](Hit<Real>& h) {
          if (h.t != 0) h.t = -h.t;
          h.facing = h.facing == Facing::Front ? Facing::Back : Facing::Front;
        },
        "backwards");
  }
}

}  // namespace
}  // namespace pierce
