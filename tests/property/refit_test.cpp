// SPDX-License-Identifier: Apache-2.0
//
// A refitted scene and one built anew from the same vertices cannot be told apart by asking.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/hard_points.h"
#include "support/hard_rays.h"
#include "support/run_cases.h"
#include "support/same_answers.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

constexpr Quality kQualities[] = {Quality::Fast, Quality::Balanced, Quality::High,
                                  Quality::Compact};

template <class Real>
BuildOptions with(Quality quality) {
  BuildOptions options;
  options.quality = quality;
  options.work.threads = 2;
  return options;
}

/// Every vertex another one.
template <class Real, class Move>
Mesh<Real> moved(Mesh<Real> mesh, const Move& move) {
  for (Vec3<Real>& v : mesh.vertices) v = move(v);
  return mesh;
}

template <class Real>
Mesh<Real> scaled(const Mesh<Real>& mesh, int by) {
  return moved(mesh, [by](const Vec3<Real>& v) {
    return Vec3<Real>{std::ldexp(v.x, by), std::ldexp(v.y, by), std::ldexp(v.z, by)};
  });
}

template <class Real>
struct Questions {
  std::vector<Ray<Real>> rays;
  std::vector<Vec3<Real>> points;

  Questions(Rng& rng, const Mesh<Real>& mesh, Style style, int count) {
    for (int i = 0; i < count; ++i) {
      rays.push_back(hard::aimed_ray(rng, mesh, style).ray);
      points.push_back(hard::hard_point(rng, mesh, style));
    }
  }
};

template <class Real>
class Refit : public testing::Test {
 public:
  /// The scene of `before`, refitted to `after`, against a scene of `after`.
  static void expect_refit_is_build(const Mesh<Real>& before, const Mesh<Real>& after,
                                    const Questions<Real>& ask) {
    for (const Quality quality : kQualities) {
      auto scene = Scene<Real>::build(before.view(), with<Real>(quality));
      // Closedness is remembered; it must be found out anew.
      (void)oracle::answer_or_error([&] {
        (void)scene.locate(before.vertices[0]);
        return std::string();
      });
      scene.refit(after.view(), {.threads = 2});
      const auto anew = Scene<Real>::build(after.view(), with<Real>(quality));
      oracle::expect_same_answers(scene, anew, ask.rays, ask.points);
      if (testing::Test::HasFatalFailure()) FAIL() << "quality " << static_cast<int>(quality);
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Refit, Reals);

TYPED_TEST(Refit, of_any_soup_to_any_other_answers_as_a_new_scene) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(12); ++i) {
    Rng rng(hard::seed() + 900, i);
    const Style style = rng.pick(hard::kAllStyles);
    const auto before = hard::soup<Real>(rng, rng.pick(hard::kAllStyles), 24);
    auto after = before;
    for (auto& v : after.vertices) v = hard::vec<Real>(rng, style);
    this->expect_refit_is_build(before, after, Questions<Real>(rng, after, style, 4));
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(Refit, to_vertices_far_larger_or_smaller_answers_as_a_new_scene) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 901, 0);
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    for (const int by : {40, -40}) {
      const auto after = scaled(mesh, by);
      const Questions<Real> ask(rng, after, Style::Unit, 6);
      this->expect_refit_is_build(mesh, after, ask);
      if (this->HasFatalFailure()) FAIL() << name;
    }
  }
}

TYPED_TEST(Refit, to_a_single_point_and_back_answers_as_a_new_scene) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 902, 0);
  const auto mesh = hard::random_voxels<Real>(rng, 4);
  const auto collapsed = moved(mesh, [](const Vec3<Real>&) { return Vec3<Real>{3, -4, 5}; });
  this->expect_refit_is_build(mesh, collapsed, Questions<Real>(rng, mesh, Style::Lattice, 8));
  this->expect_refit_is_build(collapsed, mesh, Questions<Real>(rng, mesh, Style::Lattice, 8));
}

TYPED_TEST(Refit, away_from_the_origin_moves_the_filter_space_along) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 903, 0);
  const auto mesh = hard::torus<Real>(24, 12);
  const auto away = moved(mesh, [](const Vec3<Real>& v) {
    return Vec3<Real>{v.x + 5000, v.y - 300, v.z};
  });
  this->expect_refit_is_build(mesh, away, Questions<Real>(rng, away, Style::Unit, 10));
  this->expect_refit_is_build(away, mesh, Questions<Real>(rng, mesh, Style::Unit, 10));
}

TYPED_TEST(Refit, finds_out_anew_whether_the_surface_is_closed) {
  using Real = TypeParam;
  // Two tetrahedra's worth of faces; a vertex of its own closes the surface only in one place.
  Mesh<Real> mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 4, 2}};
  auto scene = Scene<Real>::build(mesh.view());
  const Vec3<Real> middle{Real(0.125), Real(0.125), Real(0.125)};
  EXPECT_THROW((void)scene.locate(middle), Error);
  mesh.vertices[4] = {0, 0, 1};
  scene.refit();
  EXPECT_EQ(scene.locate(middle), Location::Inside);
  mesh.vertices[4] = {0, 0, 2};
  scene.refit({.threads = 1});
  EXPECT_THROW((void)scene.locate(middle), Error);
}

TYPED_TEST(Refit, of_several_meshes_answers_as_a_new_scene_after_many_steps) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 904, 0);
  for (const Quality quality : kQualities) {
    auto ball = hard::icosphere<Real>(2);
    auto needles = hard::needles<Real>(rng, 60);
    const std::vector<MeshView<Real>> views = {ball.view(), {}, needles.view()};
    auto scene = Scene<Real>::build(views, with<Real>(quality));
    for (int step = 0; step < 5; ++step) {
      for (auto* mesh : {&ball, &needles}) {
        *mesh = moved(std::move(*mesh), [&](const Vec3<Real>& v) {
          const auto by = hard::vec<Real>(rng, Style::Unit);
          return Vec3<Real>{v.x + by.x / 4, v.y + by.y / 4, v.z + by.z / 4};
        });
      }
      scene.refit();
      const Questions<Real> ask(rng, step % 2 == 0 ? ball : needles, Style::Unit, 6);
      oracle::expect_same_answers(scene, Scene<Real>::build(views, with<Real>(quality)), ask.rays,
                                  ask.points);
      if (this->HasFatalFailure()) return;
    }
  }
}

TYPED_TEST(Refit, that_throws_leaves_the_scene_as_it_was) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 905, 0);
  const auto ball = hard::icosphere<Real>(2);
  auto broken = scaled(ball, 3);
  broken.vertices[7].y = std::numeric_limits<Real>::quiet_NaN();
  auto smaller = ball;
  smaller.triangles.pop_back();
  const std::vector<MeshView<Real>> two = {ball.view(), ball.view()};
  for (const Quality quality : kQualities) {
    auto scene = Scene<Real>::build(ball.view(), with<Real>(quality));
    const auto code_of = [](const auto& refit) {
      try {
        refit();
      } catch (const Error& error) {
        return error.code();
      }
      return ErrorCode::BadFile;
    };
    EXPECT_EQ(code_of([&] { scene.refit(broken.view()); }), ErrorCode::NonFiniteVertex);
    EXPECT_EQ(code_of([&] { scene.refit(smaller.view()); }), ErrorCode::SizeMismatch);
    EXPECT_EQ(code_of([&] { scene.refit(two); }), ErrorCode::SizeMismatch);
    const Questions<Real> ask(rng, ball, Style::Unit, 6);
    oracle::expect_same_answers(scene, Scene<Real>::build(ball.view(), with<Real>(quality)),
                                ask.rays, ask.points);
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(Refit, of_an_empty_scene_is_an_empty_scene) {
  using Real = TypeParam;
  auto scene = Scene<Real>::build(MeshView<Real>{});
  scene.refit();
  EXPECT_FALSE(scene.any_hit({{0, 0, 0}, {0, 0, 1}}));
}

// Neighbours that have parted make the tree of no use: it is built anew, and is then what a new
// scene has; as long as they move together it is kept.
TYPED_TEST(Refit, builds_anew_when_a_ray_would_meet_twice_as_much) {
  Rng rng(hard::seed() + 91, 0);
  const auto before = hard::terrain<TypeParam>(rng, 40);
  const auto larger = scaled(before, 3);
  auto scattered = before;
  for (Vec3<TypeParam>& v : scattered.vertices) {
    v = {static_cast<TypeParam>(rng.between(-1000, 1000)),
         static_cast<TypeParam>(rng.between(-1000, 1000)),
         static_cast<TypeParam>(rng.between(-1000, 1000))};
  }
  for (const Quality quality : kQualities) {
    const auto anew = Scene<TypeParam>::build(scattered.view(), with<TypeParam>(quality));
    for (const bool watched : {false, true}) {
      auto scene = Scene<TypeParam>::build(before.view(), with<TypeParam>(quality));
      const double built = scene.info().sah_cost;
      WorkOptions work{.threads = 2};
      std::vector<double> heard;
      if (watched) work.progress = [&](double fraction) { heard.push_back(fraction); };
      scene.refit(larger.view(), work);
      EXPECT_NEAR(scene.info().sah_cost, built, 0.01 * built);
      scene.refit(scattered.view(), work);
      EXPECT_EQ(scene.info().sah_cost, anew.info().sah_cost);
      EXPECT_EQ(std::count(heard.begin(), heard.end(), 1.0), watched ? 2 : 0);
    }
  }
}

}  // namespace
}  // namespace pierce
