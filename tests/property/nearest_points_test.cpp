// SPDX-License-Identifier: Apache-2.0
//
// Nearest points as scenes answer them: batches are their points one by one, radii are closed, ties
// go to the smallest number, bad input is named; and every rung of the ladder is taken.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/hard_points.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class NearestPoints : public testing::Test {
 public:
  static std::vector<Vec3<Real>> draw(const Mesh<Real>& mesh, std::size_t count) {
    Rng rng(hard::seed() + 510, count);
    std::vector<Vec3<Real>> points;
    for (std::size_t i = 0; i < count; ++i) {
      points.push_back(hard::hard_point(rng, mesh, rng.one_in(8) ? Style::Mixed : Style::Unit));
    }
    return points;
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(NearestPoints, Reals);

TYPED_TEST(NearestPoints, every_thread_count_and_quality_gives_the_answers_of_single_points) {
  using Real = TypeParam;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    const auto points = this->draw(mesh, 400);
    const auto scene = Scene<Real>::build(mesh.view());
    std::vector<NearestPoint<Real>> first(points.size());
    scene.nearest_points(points, first, {.work = {.threads = 1}});
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(scene.nearest_point(points[i]).value(), first[i])
          << name << ' ' << show::text(points[i]);
    }
    for (const Quality quality : {Quality::Fast, Quality::High, Quality::Compact}) {
      const auto other = Scene<Real>::build(mesh.view(), {.quality = quality});
      std::vector<NearestPoint<Real>> answers(points.size());
      other.nearest_points(points, answers, {.work = {.threads = 2}});
      EXPECT_EQ(answers, first) << name;
    }
  }
}

TYPED_TEST(NearestPoints, a_triangle_exactly_as_far_away_as_the_radius_counts) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(2);
  const auto scene = Scene<Real>::build(cube.view());
  const Vec3<Real> above{Real(0.25), Real(0.5), Real(2.75)};
  EXPECT_TRUE(scene.nearest_point(above, Real(0.75)));
  EXPECT_FALSE(scene.nearest_point(above, std::nextafter(Real(0.75), Real(0))));
  EXPECT_TRUE(scene.nearest_point({1, 1, 2}, 0)) << "on the surface";
  EXPECT_FALSE(scene.nearest_point({1, 1, 1}, std::nextafter(Real(1), Real(0))));
  // 3-4-5 away from the corner at the origin.
  EXPECT_TRUE(scene.nearest_point({-3, -4, 0}, 5));
  EXPECT_FALSE(scene.nearest_point({-3, -4, 0}, std::nextafter(Real(5), Real(0))));

  const std::vector<Vec3<Real>> points(3, above);
  const std::vector<Real> radii{1, Real(0.5), Real(0.75)};
  std::vector<NearestPoint<Real>> found(3);
  scene.nearest_points(points, found, {.radii = radii});
  EXPECT_EQ(found[0].distance, Real(0.75));
  EXPECT_EQ(found[1], NearestPoint<Real>{});
  EXPECT_EQ(found[2], found[0]);
}

TYPED_TEST(NearestPoints, of_equally_near_triangles_the_smallest_number_is_named) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(2);
  const std::vector<MeshView<Real>> twice{cube.view(), cube.view()};
  const auto scene = Scene<Real>::build(twice);
  const auto once = Scene<Real>::build(cube.view());
  for (const Vec3<Real>& vertex : cube.vertices) {
    const auto found = scene.nearest_point(vertex).value();
    EXPECT_EQ(found, once.nearest_point(vertex).value());
    EXPECT_EQ(found.point, vertex);
    EXPECT_EQ(found.distance, 0);
    EXPECT_LE(static_cast<int>(found.feature), static_cast<int>(Feature::VertexC));
    for (std::uint32_t i = 0; i < found.triangle; ++i) {
      for (const std::uint32_t corner : cube.triangles[i]) {
        EXPECT_NE(cube.vertices[corner], vertex) << "a smaller number was passed over";
      }
    }
  }
}

TYPED_TEST(NearestPoints, triangles_that_have_shrunk_to_a_segment_or_a_point_count) {
  using Real = TypeParam;
  const std::vector<Vec3<Real>> vertices{{0, 0, 0}, {4, 0, 0}, {1, 0, 0}, {0, 9, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 3, 3}};
  const auto scene = Scene<Real>::build({vertices, triangles});
  const auto on_segment = scene.nearest_point({2, 3, 0}).value();
  EXPECT_EQ(on_segment.triangle, 0u);
  EXPECT_EQ(on_segment.feature, Feature::EdgeAB);
  EXPECT_EQ(on_segment.point, (Vec3<Real>{2, 0, 0}));
  EXPECT_EQ(on_segment.distance, 3);
  EXPECT_EQ(on_segment.u, Real(0.5));
  EXPECT_EQ(scene.nearest_point({1, 1, 0}).value().feature, Feature::VertexC);
  const auto on_point = scene.nearest_point({0, 8, 0}).value();
  EXPECT_EQ(on_point.triangle, 1u);
  EXPECT_EQ(on_point.feature, Feature::VertexA);
}

TYPED_TEST(NearestPoints, an_empty_scene_has_none_and_bad_input_is_named) {
  using Real = TypeParam;
  const auto empty = Scene<Real>::build(MeshView<Real>{});
  EXPECT_FALSE(empty.nearest_point({0, 0, 0}));
  const auto cube = hard::lattice_cube<Real>(1);
  const auto scene = Scene<Real>::build(cube.view());
  constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
  const auto error = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_NE(error([&] {
              (void)scene.nearest_point({0, kNan, 0});
            }).find("not finite"),
            std::string::npos);
  EXPECT_NE(error([&] {
              (void)scene.nearest_point({0, 0, 0}, -1);
            }).find("negative"),
            std::string::npos);
  EXPECT_NE(error([&] {
              (void)scene.nearest_point({0, 0, 0}, kNan);
            }).find("not a number"),
            std::string::npos);
  const std::vector<Vec3<Real>> points(2);
  std::vector<NearestPoint<Real>> one(1), two(2);
  EXPECT_NE(error([&] { scene.nearest_points(points, one); }).find("2 points but room for 1"),
            std::string::npos);
  const std::vector<Real> radii{1, -1};
  EXPECT_NE(error([&] {
              scene.nearest_points(points, two, {.radii = radii});
            }).find("radius of point 1 is negative"),
            std::string::npos);
}

TYPED_TEST(NearestPoints, ordinary_points_need_no_exact_arithmetic_and_lattice_points_do) {
  using Real = TypeParam;
  const auto count = [](const Mesh<Real>& mesh, const std::vector<Vec3<Real>>& points) {
    const auto scene = Scene<Real>::build(mesh.view());
    Statistics statistics;
    std::vector<NearestPoint<Real>> found(points.size());
    scene.nearest_points(points, found, {.work = {.threads = 1, .statistics = &statistics}});
    EXPECT_EQ(statistics.rays, points.size());
    EXPECT_EQ(statistics.hits, points.size());
    return statistics;
  };
  Rng rng(1, 1);
  std::vector<Vec3<Real>> ordinary;
  for (int i = 0; i < 2000; ++i) ordinary.push_back(hard::vec<Real>(rng, Style::Unit));
  const Statistics easy = count(hard::icosphere<Real>(4), ordinary);
  EXPECT_EQ(easy.settled + easy.settled_big, 0u);
  EXPECT_EQ(easy.rounded_exactly, 0u);

  std::vector<Vec3<Real>> lattice;
  for (int i = 0; i < 500; ++i) lattice.push_back(hard::vec<Real>(rng, Style::Lattice));
  const Statistics hard = count(hard::lattice_cube<Real>(3), lattice);
  EXPECT_GT(hard.certified, 0u);
  EXPECT_GT(hard.settled, 0u);
  EXPECT_GT(hard.orders_settled, 0u);
  EXPECT_GT(hard.rounded_exactly, 0u);

  const std::vector<Vec3<Real>> far(
      3, {std::numeric_limits<Real>::max(), std::numeric_limits<Real>::denorm_min(), 1});
  const Statistics any_size = count(hard::lattice_cube<Real>(1), far);
  EXPECT_GT(any_size.settled_big, 0u);
}

}  // namespace
}  // namespace pierce
