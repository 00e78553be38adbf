// SPDX-License-Identifier: Apache-2.0
//
// A ball that is lit from inside leaks nothing: walks that bounce inside closed meshes, off faces,
// edges and vertices, never leave, and what passes through is outside at once. Every start is
// strictly on its side of the plane that was hit, by rationals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/hard_rays.h"
#include "support/rational_oracle.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

// The ball with its vertices pulled in and out: needles, and corners as sharp as floats allow.
template <class Real>
Mesh<Real> thorny_ball() {
  auto mesh = hard::icosphere<Real>(2);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Real k = i % 3 == 0 ? Real(4) : i % 3 == 1 ? Real(0.0625) : Real(1);
    auto& v = mesh.vertices[i];
    v = {v.x * k, v.y * k, v.z * k};
  }
  return mesh;
}

using oracle::Rational;
using oracle::RationalVec;

RationalVec minus(const RationalVec& p, const RationalVec& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

// N . v for a vector from the triangle's first corner, or for any direction.
template <class Real>
int sign_along_normal(const Mesh<Real>& mesh, const Triangle& triangle, const RationalVec& v) {
  const RationalVec a = oracle::rational(mesh.vertices[triangle[0]]);
  const RationalVec e = minus(oracle::rational(mesh.vertices[triangle[1]]), a);
  const RationalVec f = minus(oracle::rational(mesh.vertices[triangle[2]]), a);
  const Rational volume = v[0] * (e[1] * f[2] - e[2] * f[1]) + v[1] * (e[2] * f[0] - e[0] * f[2]) +
                          v[2] * (e[0] * f[1] - e[1] * f[0]);
  return sgn(volume);
}

// On which side of the plane s lies.
template <class Real>
int side_of(const Mesh<Real>& mesh, std::uint32_t number, const Vec3<Real>& s) {
  const Triangle& triangle = mesh.triangles[number];
  return sign_along_normal(
      mesh, triangle, minus(oracle::rational(s), oracle::rational(mesh.vertices[triangle[0]])));
}

// Whether the ray is parallel to some triangle: only then may there be no start.
template <class Real>
bool is_parallel_to_some(const Mesh<Real>& mesh, const Ray<Real>& ray) {
  const RationalVec d = oracle::rational(ray.direction);
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& triangle) {
    return sign_along_normal(mesh, triangle, d) == 0;
  });
}

struct Tally {
  std::size_t bounces = 0, none = 0, outside = 0;
};

template <class Real>
class NextOrigin : public testing::Test {
 public:
  static Vec3<Real> direction(Rng& rng, const Mesh<Real>& mesh, const Vec3<Real>& from) {
    const auto towards = [&](const Vec3<Real>& p) {
      return Vec3<Real>{p.x - from.x, p.y - from.y, p.z - from.z};
    };
    const auto vertex = [&] { return mesh.vertices[rng.below(mesh.vertices.size())]; };
    Vec3<Real> d = hard::vec<Real>(rng, Style::Unit);
    switch (rng.below(4)) {
      case 0:
        d = towards(vertex());
        break;
      case 1: {
        const Triangle& t = mesh.triangles[rng.below(mesh.triangles.size())];
        const auto &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]];
        d = towards({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
        break;
      }
      case 2:
        if (rng.coin()) d = hard::vec<Real>(rng, Style::SmallInteger);
        break;
      default:
        break;
    }
    return d == Vec3<Real>{0, 0, 0} ? Vec3<Real>{1, 0, 0} : d;
  }

  // A walk that never leaves, from `start`.
  static void bounce(Rng& rng, const Mesh<Real>& mesh, const Scene<Real>& scene,
                     const Vec3<Real>& start, std::size_t bounces, bool check_sides, Tally& tally) {
    Vec3<Real> at = start;
    for (std::size_t i = 0; i < bounces; ++i) {
      const Ray<Real> ray{at, direction(rng, mesh, at)};
      const auto hit = scene.closest_hit(ray);
      ASSERT_TRUE(hit) << "lost: " << show::text(ray);
      const auto beyond = scene.next_origin(ray, *hit, Side::Beyond);
      const auto before = scene.next_origin(ray, *hit, Side::Before);
      ++tally.bounces;
      if (!before || !beyond) {
        ++tally.none;
        ASSERT_TRUE(is_parallel_to_some(mesh, ray)) << "no start found: " << show::text(ray);
      }
      const int front = hit->facing == Facing::Front ? 1 : -1;  // the ray comes from the front
      // At an edge or a vertex the region counts, not the plane.
      const bool in_face = hit->u > 0 && hit->v > 0 && hit->w > 0;
      if (beyond && check_sides && in_face) {
        ASSERT_EQ(side_of(mesh, hit->triangle, *beyond), -front) << show::text(ray);
      }
      if (!before) {
        at = start;
        continue;
      }
      if (check_sides && in_face) {
        ASSERT_EQ(side_of(mesh, hit->triangle, *before), front) << show::text(ray);
      }
      ASSERT_EQ(scene.locate(*before), Location::Inside)
          << "leaked from " << show::text(ray) << " to " << show::text(*before);
      if (beyond) tally.outside += scene.locate(*beyond) == Location::Outside ? 1 : 0;
      at = *before;
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(NextOrigin, Reals);

TYPED_TEST(NextOrigin, a_ball_lit_from_inside_leaks_nothing) {
  using Real = TypeParam;
  auto meshes = hard::small_closed_meshes<Real>();
  meshes.push_back({"bunny", hard::bunny<Real>()});
  meshes.push_back({"thorny ball", thorny_ball<Real>()});
  Rng rng(hard::seed() + 530, 0);
  const std::size_t bounces = hard::case_count(600);
  for (const auto& [name, mesh] : meshes) {
    const auto scene = Scene<Real>::build(mesh.view());
    Tally tally;
    for (const Vec3<Real>& start : hard::points_inside(rng, mesh, 4)) {
      this->bounce(rng, mesh, scene, start, bounces / 4, bounces <= 600, tally);
      if (this->HasFatalFailure()) {
        std::printf("in the %s\n", name.c_str());
        return;
      }
    }
    if (hard::enough_cases(600)) {
      EXPECT_GT(tally.outside, tally.bounces * 9 / 10) << name;
    }
    std::printf("%s: %zu bounces, %zu along a face, %zu beyond lie outside\n", name.c_str(),
                tally.bounces, tally.none, tally.outside);
  }
}

TYPED_TEST(NextOrigin, is_next_to_the_hit_and_names_what_is_no_hit) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(1);
  const auto scene = Scene<Real>::build(cube.view());
  const Ray<Real> ray{{Real(0.25), Real(0.75), 3}, {0, 0, -1}};
  const auto hit = scene.closest_hit(ray).value();
  const Real infinity = kInfinity<Real>;
  EXPECT_EQ(scene.next_origin(ray, hit, Side::Before),
            (Vec3<Real>{Real(0.25), Real(0.75), std::nextafter(Real(1), infinity)}));
  EXPECT_EQ(scene.next_origin(ray, hit, Side::Beyond),
            (Vec3<Real>{Real(0.25), Real(0.75), std::nextafter(Real(1), -infinity)}));
  // Two faces that coincide are passed together.
  const std::vector<MeshView<Real>> twice{cube.view(), cube.view()};
  const auto both = Scene<Real>::build(twice);
  EXPECT_EQ(both.next_origin(ray, both.closest_hit(ray).value(), Side::Beyond),
            scene.next_origin(ray, hit, Side::Beyond));
  // Along a face, from its edge on: there is no beyond.
  const Ray<Real> along{{-1, Real(0.5), 1}, {1, 0, 0}};
  const auto edge = scene.closest_hit(along).value();
  EXPECT_FALSE(scene.next_origin(along, edge, Side::Beyond));
  EXPECT_TRUE(scene.next_origin(along, edge, Side::Before));

  const Ray<Real> past{{5, 5, 5}, {0, 0, 1}};
  EXPECT_THROW((void)scene.next_origin(past, hit, Side::Before), Error);
  EXPECT_THROW((void)scene.next_origin(ray, Hit<Real>{}, Side::Before), Error);
}

// Which triangle in the way is met first depends on the tree; the start must not.
TYPED_TEST(NextOrigin, is_the_same_for_every_quality) {
  using Real = TypeParam;
  std::size_t starts = 0;
  for (std::uint64_t i = 0; i < hard::case_count(20); ++i) {
    Rng rng(hard::seed() + 702, i);
    const auto mesh = hard::soup<Real>(rng, Style::Unit, 30);
    std::vector<Scene<Real>> scenes;
    for (const auto quality : {Quality::Fast, Quality::Balanced, Quality::High, Quality::Compact}) {
      BuildOptions options;
      options.quality = quality;
      scenes.push_back(Scene<Real>::build(mesh.view(), options));
    }
    for (int k = 0; k < 10; ++k) {
      const auto ray = hard::aimed_ray(rng, mesh, Style::Unit).ray;
      std::vector<Hit<Real>> hits;
      scenes[0].all_hits(ray, hits);
      for (const auto& hit : hits) {
        for (const Side side : {Side::Before, Side::Beyond}) {
          const auto start = scenes[0].next_origin(ray, hit, side);
          starts += start ? 1 : 0;
          for (const auto& other : scenes) {
            ASSERT_EQ(other.next_origin(ray, hit, side), start) << i << ' ' << show::text(ray);
          }
        }
      }
    }
  }
  if (hard::enough_cases(20)) {
    EXPECT_GT(starts, 300u);
  }
}

// A wedge of two upright walls, so narrow where the ray hits that there is no float between them, a
// triangle in the ray's plane but in nobody's way, and some more beside, which the tree keeps in
// one leaf with the others or not.
TEST(NextOriginInAWedge, is_the_same_for_every_quality_and_after_a_refit) {
  using V = Vec3<float>;
  std::size_t starts = 0;
  for (std::uint64_t i = 0; i < hard::case_count(200); ++i) {
    Rng rng(hard::seed() + 715, i);
    const auto within = [&](double low, double high) {
      return static_cast<float>(low + (high - low) * rng.unit());
    };
    constexpr float kPlace = 0.7F, kUlp = 0x1p-24F;
    Mesh<float> mesh;
    const auto add = [&mesh](const V& a, const V& b, const V& c) {
      const std::uint32_t first = mesh.add(a);
      mesh.add(b);
      mesh.add(c);
      mesh.triangles.push_back({first, first + 1, first + 2});
    };
    add({1, -1, -1}, {1, 2, -1}, {1, 0.5F, 3});  // what is hit
    add({-1, kPlace - 3 * kUlp, -1}, {1.5F, kPlace + kUlp, -1}, {0.25F, kPlace - kUlp, 3});
    add({-1, kPlace + 4 * kUlp, -1}, {1.5F, kPlace, -1}, {0.25F, kPlace + 2 * kUlp, 3});
    const float x = within(0.9, 0.99), above = kPlace + within(0.001, 0.2);
    add({x, above, 0}, {x + 1e-4F, above + 1, 0}, {x - 1e-4F, above + 1, 0});
    for (std::uint64_t more = rng.below(60); more > 0; --more) {
      const V p{within(-1, 3), within(0.75, 3), within(-1, 1)};
      const auto near = [&] {
        return V{p.x + within(-0.1, 0.1), p.y + within(0, 0.1), p.z + within(-0.1, 0.1)};
      };
      add(p, near(), near());
    }
    const Ray<float> ray{{-0.5F, kPlace, 0}, {1, kUlp / 3, 0}};
    Mesh<float> elsewhere = mesh;
    for (V& v : elsewhere.vertices) v = {within(-1, 3), within(-1, 3), within(-1, 1)};
    std::vector<Scene<float>> scenes;
    for (const auto quality : {Quality::Fast, Quality::Balanced, Quality::High, Quality::Compact}) {
      scenes.push_back(Scene<float>::build(mesh.view(), {.quality = quality}));
    }
    scenes.push_back(Scene<float>::build(elsewhere.view()));
    scenes.back().refit(mesh.view());
    const auto hit = scenes[0].closest_hit(ray);
    ASSERT_TRUE(hit) << i;
    const auto start = scenes[0].next_origin(ray, *hit, Side::Before);
    starts += start ? 1 : 0;
    for (const auto& other : scenes) {
      ASSERT_EQ(other.next_origin(ray, *hit, Side::Before), start) << i;
    }
  }
  EXPECT_GT(starts, hard::case_count(200) / 2);
}

// A triangle in the plane of the ray, beyond the wall that is hit.
TYPED_TEST(NextOrigin, the_rays_own_origin_will_do_where_nothing_is_before_the_hit) {
  using Real = TypeParam;
  const std::vector<Vec3<Real>> vertices = {{1, 0, -2},  {3, 1, -2}, {1, 1, -2},
                                            {1, -1, -3}, {1, 1, -3}, {1, Real(-0.5), 5}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto scene = Scene<Real>::build({vertices, triangles});
  const Ray<Real> ray{{0, 0, -2}, {1, Real(-0x1p-60), 0}};
  const auto hit = scene.closest_hit(ray).value();
  EXPECT_EQ(hit.triangle, 1U);
  EXPECT_TRUE(scene.next_origin(ray, hit, Side::Before));
}

// Sheets one unit in the last place apart: between them there is nothing to start from.
TYPED_TEST(NextOrigin, says_so_where_there_is_no_room) {
  using Real = TypeParam;
  const Real above = std::nextafter(Real(1), Real(2));
  const std::vector<Vec3<Real>> vertices{{0, 0, 1},     {4, 0, 1},     {0, 4, 1},
                                         {0, 0, above}, {4, 0, above}, {0, 4, above}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const auto scene = Scene<Real>::build({vertices, triangles});
  const Ray<Real> ray{{1, 1, 3}, {0, 0, -1}};
  const auto hit = scene.closest_hit(ray).value();
  EXPECT_EQ(hit.triangle, 1u);
  EXPECT_TRUE(scene.next_origin(ray, hit, Side::Before));
  EXPECT_FALSE(scene.next_origin(ray, hit, Side::Beyond));
}

TYPED_TEST(NextOrigin, a_batch_is_its_rays_one_by_one_and_misses_have_none) {
  using Real = TypeParam;
  const auto mesh = hard::icosphere<Real>(2);
  const auto scene = Scene<Real>::build(mesh.view());
  Rng rng(hard::seed() + 531, 0);
  std::vector<Ray<Real>> rays;
  for (int i = 0; i < 700; ++i) {
    const Vec3<Real> from = hard::vec<Real>(rng, Style::Unit);
    rays.push_back({from, this->direction(rng, mesh, from)});
  }
  std::vector<Hit<Real>> hits(rays.size());
  scene.closest_hits(rays, hits);
  std::size_t misses = 0;
  for (const unsigned threads : {1U, 2U}) {
    for (const Side side : {Side::Before, Side::Beyond}) {
      std::vector<std::optional<Vec3<Real>>> starts(rays.size(), Vec3<Real>{7, 7, 7});
      scene.next_origins(rays, hits, side, starts, {.work = {.threads = threads}});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool miss = hits[i].triangle == kNone;
        misses += miss ? 1 : 0;
        const auto one = miss ? std::nullopt : scene.next_origin(rays[i], hits[i], side);
        ASSERT_EQ(starts[i], one) << show::text(rays[i]);
      }
    }
  }
  EXPECT_GT(misses, 10U);
  EXPECT_LT(misses, rays.size());
}

TYPED_TEST(NextOrigin, a_batch_names_the_first_ray_whose_hit_is_none_of_its_own) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(1);
  const auto scene = Scene<Real>::build(cube.view());
  std::vector<Ray<Real>> rays(5, Ray<Real>{{Real(0.25), Real(0.75), 3}, {0, 0, -1}});
  std::vector<Hit<Real>> hits(5);
  scene.closest_hits(rays, hits);
  rays[2].origin = rays[4].origin = {5, 5, 5};
  std::vector<std::optional<Vec3<Real>>> starts(5);
  try {
    scene.next_origins(rays, hits, Side::Before, starts);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::InvalidArgument);
    EXPECT_EQ(std::string(e.what()).find("ray 2 (the first of 2) does not hit triangle "), 0U)
        << e.what();
  }
  EXPECT_THROW(scene.next_origins(rays, std::span(hits).first(4), Side::Before, starts), Error);
}

}  // namespace
}  // namespace pierce
