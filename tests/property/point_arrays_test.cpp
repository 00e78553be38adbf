// SPDX-License-Identifier: Apache-2.0
//
// Points in arrays of every layout are answered as an array of Vec3 is, bit by bit, and nothing is
// written beside what was asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "pierce/scene.h"
#include "support/meshes.h"
#include "support/run_cases.h"
#include "support/strided_array.h"

namespace pierce {
namespace {

using hard::Layout;
using hard::StridedArray;

template <class T>
bool same(const T& x, const T& y) {
  return std::memcmp(&x, &y, sizeof x) == 0;
}

template <class Real>
class PointArrays : public testing::Test {
 public:
  hard::Mesh<Real> mesh = hard::icosphere<Real>(3);
  Scene<Real> scene = Scene<Real>::build(mesh.view());
  hard::Rng rng{hard::seed(), 79};

  void compare(Layout layout, std::size_t n) {
    StridedArray<Real> table(rng, layout, n, 3);
    std::vector<Vec3<Real>> points;
    for (std::size_t i = 0; i < n; ++i) {
      Vec3<Real> p = {Real(rng.symmetric()), Real(rng.symmetric()), Real(rng.symmetric())};
      if (rng.one_in(5)) p = mesh.vertices[rng.below(mesh.vertices.size())];
      points.push_back(p);
      table.set(i, 0, p.x), table.set(i, 1, p.y), table.set(i, 2, p.z);
    }
    const Rows<const Real> rows_of_points = table.rows();

    std::vector<Location> locations(n);
    StridedArray<std::int8_t> where(rng, layout, n, 1);
    scene.locate(points, locations);
    scene.locate(rows_of_points, where.rows());
    std::vector<Real> distances(n);
    StridedArray<Real> how_far(rng, layout, n, 1);
    scene.signed_distances(points, distances);
    scene.signed_distances(rows_of_points, how_far.rows());

    const NearestOptions<Real> near{.radius = Real(0.25)};  // of some points there is none
    std::vector<NearestPoint<Real>> nearest(n), again(n);
    scene.nearest_points(points, nearest, near);
    StridedArray<Real> point(rng, layout, n, 3), distance(rng, layout, n, 1), u(rng, layout, n, 1),
        v(rng, layout, n, 1), w(rng, layout, n, 1);
    StridedArray<std::uint32_t> geometry(rng, layout, n, 1);
    StridedArray<std::int64_t> triangle(rng, layout, n, 1);
    StridedArray<std::uint8_t> feature(rng, layout, n, 1);
    NearestArrays<Real> all;
    all.nearest = again;
    all.point = point.rows();
    all.distance = distance.rows();
    all.u = u.rows(), all.v = v.rows(), all.w = w.rows();
    all.geometry = geometry.rows();
    all.triangle = triangle.rows();
    all.feature = feature.rows();
    scene.nearest_points(rows_of_points, all, near);
    ASSERT_EQ(again, nearest);
    for (std::size_t i = 0; i < n; ++i) {
      const NearestPoint<Real>& one = nearest[i];
      const bool none = one.triangle == kNone;
      ASSERT_EQ(where.get(i), static_cast<std::int8_t>(locations[i]));
      ASSERT_TRUE(same(how_far.get(i), distances[i]));
      const Real at[] = {one.point.x, one.point.y, one.point.z};
      for (std::size_t j = 0; j < 3; ++j) {
        ASSERT_TRUE(none ? std::isnan(point.get(i, j)) : same(point.get(i, j), at[j]));
      }
      ASSERT_TRUE(same(distance.get(i), one.distance) && same(u.get(i), one.u) &&
                  same(v.get(i), one.v) && same(w.get(i), one.w));
      ASSERT_EQ(geometry.get(i), one.geometry);
      ASSERT_EQ(triangle.get(i), none ? -1 : std::int64_t{one.triangle});
      ASSERT_EQ(feature.get(i), static_cast<std::uint8_t>(one.feature));
    }
    const auto guarded = [](auto&... each) { return (each.guards_stand() && ...); };
    ASSERT_TRUE(guarded(table, where, how_far, point, distance, u, v, w, geometry, triangle));
    ASSERT_TRUE(guarded(feature));
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PointArrays, Reals);

TYPED_TEST(PointArrays, every_layout) {
  for (const Layout layout : hard::kLayouts) {
    for (const std::size_t n : {0, 1, 255, 256, 257, 700}) this->compare(layout, n);
  }
}

TYPED_TEST(PointArrays, arrays_that_do_not_fit_are_refused_in_one_line) {
  using Real = TypeParam;
  std::vector<Vec3<Real>> points(3);
  std::vector<std::int8_t> where(2);
  std::vector<Real> distance(4);
  const auto refused = [](ErrorCode code, const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(
      refused(ErrorCode::SizeMismatch, [&] { this->scene.locate(rows(points), rows(where)); }),
      "there are 3 points but room for 2 results; make the spans equally long");
  NearestArrays<Real> out;
  out.distance = rows(distance);
  EXPECT_EQ(
      refused(ErrorCode::SizeMismatch, [&] { this->scene.nearest_points(rows(points), out); }),
      "there are 3 points but distance has 4 rows; give it one a point, or none");
  const Rows<const Real> nowhere{nullptr, 3};
  distance.resize(3);
  EXPECT_EQ(refused(ErrorCode::InvalidArgument,
                    [&] { this->scene.signed_distances(nowhere, rows(distance)); }),
            "points has 3 rows but no data; point it at them");
  points[1].y = kInfinity<Real>;
  EXPECT_EQ(refused(ErrorCode::InvalidPoint,
                    [&] { this->scene.signed_distances(rows(points), rows(distance)); }),
            "bad point 1 (the only one): it is not finite; give finite coordinates");
}

}  // namespace
}  // namespace pierce
