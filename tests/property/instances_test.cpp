// SPDX-License-Identifier: Apache-2.0
//
// A scene of instances cannot be told from one of the meshes that its transforms make, each
// coordinate computed by rationals and rounded once.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/hard_points.h"
#include "support/hard_rays.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/same_answers.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;
using oracle::Dyadic;

template <class Real>
Mesh<Real> placed_by_oracle(const Transform<Real>& transform, Mesh<Real> mesh) {
  for (Vec3<Real>& v : mesh.vertices) {
    const auto along = [&](std::size_t i) {
      const auto& row = transform.rows[i];
      return oracle::round_dyadic<Real>(Dyadic(row[0]) * Dyadic(v.x) +
                                        Dyadic(row[1]) * Dyadic(v.y) +
                                        Dyadic(row[2]) * Dyadic(v.z) + Dyadic(row[3]));
    };
    v = {along(0), along(1), along(2)};
  }
  return mesh;
}

/// Turned, scaled and sheared at will, and moved by some widths of the mesh.
template <class Real>
Transform<Real> any_transform(Rng& rng) {
  Transform<Real> transform;
  for (auto& row : transform.rows) {
    for (Real& x : row) x = hard::number<Real>(rng, Style::Unit);
    row[3] *= 4;
  }
  return transform;
}

template <class Real>
Transform<Real> mirrored_in_x() {
  Transform<Real> transform;
  transform.rows[0][0] = -1;
  return transform;
}

template <class Real>
class Instances : public testing::Test {
 public:
  static void expect_same(const Scene<Real>& scene, const std::vector<Mesh<Real>>& meshes,
                          const BuildOptions& options, Rng& rng) {
    std::vector<MeshView<Real>> views;
    std::vector<Ray<Real>> rays;
    std::vector<Vec3<Real>> points;
    for (const auto& mesh : meshes) {
      views.push_back(mesh.view());
      for (int i = 0; i < 4; ++i) {
        rays.push_back(hard::aimed_ray(rng, mesh, Style::Unit).ray);
        points.push_back(hard::hard_point(rng, mesh, Style::Unit));
      }
    }
    oracle::expect_same_answers(scene, Scene<Real>::build(views, options), rays, points);
  }

  /// The error of building one instance.
  static Error error_of(const Mesh<Real>& mesh, const Transform<Real>& transform,
                        const BuildOptions& options = {}) {
    const std::vector<Instance<Real>> instances = {{mesh.view()}, {mesh.view(), transform}};
    try {
      (void)Scene<Real>::build(instances, options);
    } catch (const Error& error) {
      return error;
    }
    return {ErrorCode::BadFile, "no error"};
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Instances, Reals);

TYPED_TEST(Instances, are_the_meshes_that_their_transforms_make) {
  using Real = TypeParam;
  for (const auto quality : {Quality::Fast, Quality::Balanced, Quality::High, Quality::Compact}) {
    Rng rng(hard::seed() + 930, static_cast<std::uint64_t>(quality));
    BuildOptions options;
    options.quality = quality;
    const auto meshes = hard::small_closed_meshes<Real>();
    std::vector<Instance<Real>> instances;
    std::vector<Mesh<Real>> placed;
    for (int i = 0; i < 6; ++i) {
      const auto& mesh = meshes[rng.below(meshes.size())].mesh;
      const auto transform = i == 0 ? Transform<Real>{} : any_transform<Real>(rng);
      instances.push_back({mesh.view(), transform});
      placed.push_back(placed_by_oracle(transform, mesh));
    }
    auto scene = Scene<Real>::build(instances, options);
    this->expect_same(scene, placed, options, rng);
    if (this->HasFatalFailure()) return;

    for (std::size_t i = 0; i < instances.size(); ++i) {  // and so they are when they have moved
      const auto& mesh = instances[i].mesh;
      instances[i].transform = i == 3 ? Transform<Real>{} : any_transform<Real>(rng);
      placed[i] = placed_by_oracle(instances[i].transform,
                                   Mesh<Real>{{mesh.vertices.begin(), mesh.vertices.end()},
                                              {mesh.triangles.begin(), mesh.triangles.end()}});
    }
    scene.refit(instances);
    this->expect_same(scene, placed, options, rng);
    if (this->HasFatalFailure()) return;
  }
}

/// Placements of every kind: ordinary ones, hardly moved, far away, tiny or huge or thin, by
/// numbers of any style, flattened, mirrored.
template <class Real>
Transform<Real> hard_transform(Rng& rng) {
  auto transform = any_transform<Real>(rng);
  const auto scale = [&](Real by) {
    for (auto& row : transform.rows) {
      for (int k = 0; k < 3; ++k) row[static_cast<std::size_t>(k)] *= by;
    }
  };
  switch (rng.below(8)) {
    case 0:
      return {};
    case 1:
      transform = {};
      transform.rows[rng.below(3)][3] = hard::number<Real>(rng, Style::Lattice);
      return transform;
    case 2:
      for (auto& row : transform.rows) row[3] *= 1000;
      return transform;
    case 3:
      scale(Real(0x1p-9));
      return transform;
    case 4:
      scale(Real(0x1p9));
      return transform;
    case 5:
      for (Real& x : transform.rows[rng.below(3)]) x *= Real(0x1p-7);
      return transform;
    case 6:
      if (rng.below(2) == 0) return mirrored_in_x<Real>();
      transform.rows[2] = transform.rows[1];
      return transform;
    default:
      return transform;
  }
}

TYPED_TEST(Instances, that_share_their_meshes_cannot_be_told_from_those_that_do_not) {
  using Real = TypeParam;
  const auto meshes = hard::small_closed_meshes<Real>();
  for (std::uint64_t number = 0; number < hard::case_count(4); ++number) {
    Rng rng(hard::seed() + 940, number);
    BuildOptions options;
    options.quality =
        std::array{Quality::Fast, Quality::Balanced, Quality::High, Quality::Compact}[number % 4];
    options.flatten_limit = 0;
    const auto& first = meshes[rng.below(meshes.size())].mesh;
    const auto& second = meshes[rng.below(meshes.size())].mesh;
    std::vector<Instance<Real>> instances;
    std::vector<Mesh<Real>> placed;
    const auto place = [&](const Mesh<Real>& mesh) {
      const auto transform = hard_transform<Real>(rng);
      instances.push_back({mesh.view(), transform});
      placed.push_back(placed_by_oracle(transform, mesh));
    };
    for (int i = 0; i < 9; ++i) place(i % 3 == 1 ? second : first);
    auto scene = Scene<Real>::build(instances, options);
    this->expect_same(scene, placed, options, rng);
    instances.clear();
    placed.clear();
    for (int i = 0; i < 9; ++i) place(i % 3 == 1 ? second : first);
    scene.refit(instances);
    this->expect_same(scene, placed, options, rng);
    if (this->HasFailure()) {
      ADD_FAILURE() << "case " << number;
      return;
    }
  }
}

TYPED_TEST(Instances, that_share_their_meshes_are_as_near_to_points_far_away) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 942, 0);
  const auto ball = hard::icosphere<Real>(2);
  std::vector<Instance<Real>> instances;
  for (int i = 0; i < 6; ++i) instances.push_back({ball.view(), any_transform<Real>(rng)});
  BuildOptions options;
  const auto flat = Scene<Real>::build(instances, options);
  options.flatten_limit = 0;
  const auto shared = Scene<Real>::build(instances, options);
  for (int i = 0; i < 200; ++i) {
    const auto far = [&] {
      return hard::number<Real>(rng, Style::Unit) *
             std::ldexp(Real(1), rng.between(0, std::numeric_limits<Real>::max_exponent - 4));
    };
    const Vec3<Real> point{far(), far(), far()};
    const auto expected = flat.nearest_point(point);
    for (const Real radius : {expected.value().distance, expected.value().distance / 2,
                              std::nextafter(expected.value().distance, kInfinity<Real>)}) {
      EXPECT_EQ(shared.nearest_point(point, radius), flat.nearest_point(point, radius));
    }
    EXPECT_EQ(shared.nearest_point(point), expected);
    if (i % 10 != 0) continue;
    EXPECT_EQ(oracle::answers(shared, point, {}), oracle::answers(flat, point, {}));
  }
}

// A compact scene has one space for everything.
TYPED_TEST(Instances, of_one_space_within_another_cannot_be_told_from_flat_ones) {
  using Real = TypeParam;
  const auto ball = hard::icosphere<Real>(2);
  for (std::uint64_t number = 0; number < hard::case_count(3); ++number) {
    Rng rng(hard::seed() + 941, number);
    std::vector<Mesh<Real>> meshes = {hard::lattice_cube<Real>(1)};
    const int fineness = rng.between(14, sizeof(Real) == 4 ? 16 : 40);
    for (int i = 0; i < 3; ++i) {
      Transform<Real> fine;
      for (auto& row : fine.rows) {
        for (Real& x : row)
          x = hard::number<Real>(rng, Style::Unit) * std::ldexp(Real(1), -fineness);
        row[3] = (rng.coin() ? Real(1) : Real(-1)) * Real(0.5 + 0.5 * rng.unit());
      }
      meshes.push_back(placed_by_oracle(fine, ball));
      if (i == 1) meshes.push_back(meshes.back());  // twice the same: ties
    }
    std::vector<MeshView<Real>> views;
    for (const auto& mesh : meshes) views.push_back(mesh.view());
    BuildOptions options;
    options.quality = std::array{Quality::Fast, Quality::Balanced, Quality::High}[number % 3];
    const auto scene = Scene<Real>::build(views, options);
    options.quality = Quality::Compact;
    this->expect_same(scene, meshes, options, rng);
    EXPECT_GT(scene.info().bytes, 3 * Scene<Real>::build(views, options).info().bytes);
    if (this->HasFailure()) {
      ADD_FAILURE() << "case " << number;
      return;
    }
  }
}

TYPED_TEST(Instances, of_a_closed_mesh_stay_closed_however_they_are_placed) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 931, 0);
  const auto ball = hard::icosphere<Real>(2);
  for (int i = 0; i < 20; ++i) {
    const auto transform = any_transform<Real>(rng);
    const std::vector<Instance<Real>> instances = {{ball.view(), transform}};
    const auto scene = Scene<Real>::build(instances);
    const auto centre = transformed<Real>(transform, {0, 0, 0});
    EXPECT_NE(scene.locate(centre), Location::Outside);
    // Through every vertex from the centre: an odd number of passages.
    for (const Vec3<Real>& v : ball.vertices) {
      const auto w = transformed(transform, v);
      const Ray<Real> ray{centre, {w.x - centre.x, w.y - centre.y, w.z - centre.z}};
      ASSERT_EQ(scene.crossings(ray).count % 2, 1U) << show::text(ray);
    }
  }
}

TYPED_TEST(Instances, that_are_mirrored_turn_over) {
  using Real = TypeParam;
  const auto ball = hard::icosphere<Real>(1);
  const std::vector<Instance<Real>> instances = {{ball.view(), mirrored_in_x<Real>()}};
  const auto mirrored = Scene<Real>::build(instances);
  const auto plain = Scene<Real>::build(ball.view());
  const Ray<Real> ray{{Real(0.25), Real(0.125), -3}, {0, 0, 1}};
  const Ray<Real> in_the_mirror{{Real(-0.25), Real(0.125), -3}, {0, 0, 1}};
  const auto hit = plain.closest_hit(ray).value();
  const auto image = mirrored.closest_hit(in_the_mirror).value();
  EXPECT_EQ(hit.triangle, image.triangle);
  EXPECT_EQ(hit.t, image.t);
  EXPECT_EQ(hit.facing, Facing::Front);
  EXPECT_EQ(image.facing, Facing::Back);
  // Which side faces out does not matter to parity.
  EXPECT_EQ(mirrored.locate({0, 0, 0}), Location::Inside);
}

TYPED_TEST(Instances, may_be_flattened_and_are_then_hit_where_they_have_area) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(1);
  Transform<Real> flat;
  flat.rows[2] = {0, 0, 0, 5};
  const std::vector<Instance<Real>> instances = {{cube.view(), flat}};
  const auto scene = Scene<Real>::build(instances);
  EXPECT_EQ(scene.info().degenerate, 8U);
  std::vector<Hit<Real>> hits;
  scene.all_hits({{Real(0.25), Real(0.5), 0}, {0, 0, 1}}, hits);
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_EQ(hits[0].t, 5);
  EXPECT_EQ(hits[1].t, 5);
  flat.rows[0] = flat.rows[1] = flat.rows[2];
  const std::vector<Instance<Real>> point = {{cube.view(), flat}};
  EXPECT_EQ(Scene<Real>::build(point).info().degenerate, cube.triangles.size());
}

TYPED_TEST(Instances, see_the_vertices_of_the_caller_and_copy_none_for_the_identity) {
  using Real = TypeParam;
  auto ball = hard::icosphere<Real>(2);
  std::vector<Instance<Real>> instances = {{ball.view()}};
  const std::uint64_t viewed = Scene<Real>::build(instances).info().bytes;
  instances[0].transform.rows[0][3] = 2;
  auto scene = Scene<Real>::build(instances);
  EXPECT_GE(scene.info().bytes, viewed + ball.vertices.size() * sizeof(Vec3<Real>) - 4096);
  // Changed in place: the transform is applied anew.
  for (auto& v : ball.vertices) v = {v.x * 2, v.y * 2, v.z * 2};
  scene.refit();
  const auto hit = scene.closest_hit({{2, 0, -10}, {0, 0, 1}});
  const auto expected = Scene<Real>::build(ball.view()).closest_hit({{0, 0, -10}, {0, 0, 1}});
  EXPECT_EQ(hit.value().t, expected.value().t);
  // From instances to meshes: there are only those then.
  scene.refit(ball.view());
  EXPECT_EQ(scene.closest_hit({{0, 0, -10}, {0, 0, 1}}), expected);
  EXPECT_LT(scene.info().bytes, viewed + 4096);
}

TYPED_TEST(Instances, that_cannot_be_are_refused_by_name) {
  using Real = TypeParam;
  auto ball = hard::icosphere<Real>(1);
  Transform<Real> huge;
  huge.rows[1][1] = std::numeric_limits<Real>::max();
  huge.rows[1][3] = std::numeric_limits<Real>::max() / 2;
  Error error = this->error_of(ball, huge);
  EXPECT_EQ(error.code(), ErrorCode::NonFiniteVertex);
  EXPECT_NE(std::string(error.what()).find("of instance 1 (the first of "), std::string::npos)
      << error.what();
  huge.rows[1][1] = std::numeric_limits<Real>::quiet_NaN();
  error = this->error_of(ball, huge);
  EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
  EXPECT_NE(std::string(error.what()).find("transform of instance 1"), std::string::npos);

  // What is wrong with the mesh is said as it is without instances; what nobody uses may be so.
  ball.add({0, std::numeric_limits<Real>::infinity(), 0});
  EXPECT_STREQ(this->error_of(ball, mirrored_in_x<Real>()).what(), "no error");
  ball.triangles.push_back({0, 1, static_cast<std::uint32_t>(ball.vertices.size() - 1)});
  EXPECT_EQ(this->error_of(ball, mirrored_in_x<Real>()).code(), ErrorCode::NonFiniteVertex);
  ball.triangles.back()[0] = 1000;
  EXPECT_EQ(this->error_of(ball, mirrored_in_x<Real>()).code(), ErrorCode::IndexOutOfRange);
}

TYPED_TEST(Instances, that_cannot_be_leave_a_refitted_scene_as_it_was) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 932, 0);
  const auto ball = hard::icosphere<Real>(1);
  const auto transform = any_transform<Real>(rng);
  std::vector<Instance<Real>> instances = {{ball.view(), transform}};
  auto scene = Scene<Real>::build(instances);
  instances[0].transform.rows[0][0] = std::numeric_limits<Real>::infinity();
  EXPECT_THROW(scene.refit(instances), Error);
  instances.clear();
  EXPECT_THROW(scene.refit(instances), Error);
  this->expect_same(scene, {placed_by_oracle(transform, ball)}, {}, rng);
}

TYPED_TEST(Instances, can_be_stopped_like_any_build) {
  using Real = TypeParam;
  std::atomic<bool> stop = false;
  stop = true;
  BuildOptions options;
  options.work.stop = &stop;
  EXPECT_EQ(this->error_of(hard::icosphere<Real>(1), mirrored_in_x<Real>(), options).code(),
            ErrorCode::Stopped);
}

TYPED_TEST(Instances, of_single_points_are_what_transformed_says) {
  using Real = TypeParam;
  const Real infinity = kInfinity<Real>;
  const auto mirror = mirrored_in_x<Real>();
  EXPECT_EQ(transformed<Real>(mirror, {1, 2, 3}), (Vec3<Real>{-1, 2, 3}));
  EXPECT_FALSE(std::signbit(transformed<Real>(mirror, {0, 0, 0}).x));
  EXPECT_THROW((void)transformed<Real>(mirror, {infinity, 0, 0}), Error);
  Transform<Real> twice = mirror;
  twice.rows[0][1] = std::numeric_limits<Real>::max();
  EXPECT_THROW((void)transformed<Real>(twice, {0, 2, 0}), Error);
}

}  // namespace
}  // namespace pierce
