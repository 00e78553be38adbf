// SPDX-License-Identifier: Apache-2.0
//
// Signed distance: the sign is that of locate, the size that of the nearest point, in batches as
// alone.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/hard_points.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;
using hard::Style;

template <class Real>
class SignedDistance : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SignedDistance, Reals);

TYPED_TEST(SignedDistance, is_the_distance_with_the_sign_of_the_place) {
  using Real = TypeParam;
  Rng rng(hard::seed() + 520, 0);
  std::size_t inside = 0;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    const auto scene = Scene<Real>::build(mesh.view());
    std::vector<Vec3<Real>> points;
    for (int i = 0; i < 300; ++i) points.push_back(hard::hard_point(rng, mesh, Style::Unit));
    std::vector<Real> distances(points.size());
    scene.signed_distances(points, distances, {.work = {.threads = 2}});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Real alone = scene.signed_distance(points[i]);
      ASSERT_TRUE(show::same_bits(distances[i], alone)) << name << ' ' << show::text(points[i]);
      ASSERT_EQ(std::fabs(alone), scene.nearest_point(points[i]).value().distance);
      ASSERT_FALSE(alone == 0 && std::signbit(alone)) << "minus zero";
      const Location location = scene.locate(points[i]);
      if (alone != 0) {
        ASSERT_EQ(alone < 0, location == Location::Inside) << name << ' ' << show::text(points[i]);
      }
      if (location == Location::OnSurface) {
        ASSERT_EQ(alone, 0);
      }
      inside += alone < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 50u);
}

TYPED_TEST(SignedDistance, needs_a_closed_mesh_unless_told_otherwise) {
  using Real = TypeParam;
  auto cube = hard::lattice_cube<Real>(1);
  const auto whole = Scene<Real>::build(cube.view());
  const Vec3<Real> middle{Real(0.5), Real(0.5), Real(0.25)};
  EXPECT_EQ(whole.signed_distance(middle), Real(-0.25));
  EXPECT_EQ(Scene<Real>::build(MeshView<Real>{}).signed_distance(middle), kInfinity<Real>);
  cube.triangles.pop_back();
  const auto open = Scene<Real>::build(cube.view());
  EXPECT_THROW((void)open.signed_distance(middle), Error);
  EXPECT_EQ(std::fabs(open.signed_distance(middle, {.open_mesh = true})), Real(0.25));
}

}  // namespace
}  // namespace pierce
