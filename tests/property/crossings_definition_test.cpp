// SPDX-License-Identifier: Apache-2.0
//
// Does the definition of a crossing do what it promises? Asked of the oracle, which is nothing but
// the definition: on closed meshes parity and signed count do not depend on the direction, however
// the ray runs: through vertices, along edges, in faces. Points with an answer known beforehand
// have that answer.
#include <gtest/gtest.h>

#include <vector>

#include "support/brute_force.h"
#include "support/closed_meshes.h"
#include "support/hard_rays.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class CrossingsDefinition : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(CrossingsDefinition, Reals);

// The shift of the origin is the same for all directions, so a point on the surface, too, has one
// parity and one winding number.
TYPED_TEST(CrossingsDefinition, the_signed_count_does_not_depend_on_the_direction) {
  using Real = TypeParam;
  int on_surface = 0, inside = 0, outside = 0;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    const oracle::BruteForce<Real> truth(mesh.view());
    for (std::uint64_t i = 0; i < 40; ++i) {
      Rng rng(hard::seed(), i);
      const auto first = hard::aimed_ray(rng, mesh, Style::Lattice);
      const Vec3<Real> origin =
          rng.one_in(3) ? mesh.vertices[rng.below(mesh.vertices.size())] : first.ray.origin;
      const Crossings expected = truth.crossings({origin, first.ray.direction});
      for (int k = 0; k < 6; ++k) {
        const Ray<Real> ray{origin, hard::aimed_ray(rng, mesh, Style::Lattice).ray.direction};
        const Crossings found = truth.crossings(ray);
        ASSERT_EQ(found.signed_count, expected.signed_count) << name << show::text(ray);
        ASSERT_EQ(found.count % 2, expected.count % 2) << name << show::text(ray);
        ASSERT_EQ(found.origin_on_surface, expected.origin_on_surface) << name << show::text(ray);
      }
      ASSERT_TRUE(expected.signed_count == 0 || expected.signed_count == 1)
          << name << " faces outward, so the winding number is 0 or 1";
      on_surface += expected.origin_on_surface ? 1 : 0;
      (expected.signed_count == 1 ? inside : outside) += 1;
    }
  }
  EXPECT_GT(on_surface, 20);
  EXPECT_GT(inside, 10);
  EXPECT_GT(outside, 10);
}

TYPED_TEST(CrossingsDefinition, lattice_points_of_a_cube_are_where_they_are) {
  using Real = TypeParam;
  constexpr int kSize = 3;
  const auto cube = hard::lattice_cube<Real>(kSize);
  const oracle::BruteForce<Real> truth(cube.view());
  for (int i = -2; i <= 2 * kSize + 2; ++i) {
    for (int j = -2; j <= 2 * kSize + 2; ++j) {
      for (int k = -2; k <= 2 * kSize + 2; ++k) {
        const auto half = [](int n) { return static_cast<Real>(n) / 2; };
        const auto within = [](int n) { return n > 0 && n < 2 * kSize; };
        const auto beyond = [](int n) { return n < 0 || n > 2 * kSize; };
        const Location expected = beyond(i) || beyond(j) || beyond(k)   ? Location::Outside
                                  : within(i) && within(j) && within(k) ? Location::Inside
                                                                        : Location::OnSurface;
        ASSERT_EQ(truth.locate({half(i), half(j), half(k)}), expected) << i << " " << j << " " << k;
      }
    }
  }
}

// A touch is no passage or two of opposite sign; a passage through a vertex or an edge is one.
TYPED_TEST(CrossingsDefinition, a_passage_through_an_edge_or_a_vertex_is_one) {
  using Real = TypeParam;
  const auto cube = hard::lattice_cube<Real>(2);
  const oracle::BruteForce<Real> truth(cube.view());
  const auto crossings = [&](const Ray<Real>& ray) { return truth.crossings(ray); };
  EXPECT_EQ(crossings({{1, 1, -5}, {0, 0, 1}}), (Crossings{2, 0, false}));  // two vertices
  EXPECT_EQ(crossings({{1, 1, 1}, {0, 0, 1}}), (Crossings{1, 1, false}));
  EXPECT_EQ(crossings({{1, Real(0.5), 1}, {0, 0, 1}}), (Crossings{1, 1, false}));  // an edge
  EXPECT_EQ(crossings({{1, 1, 1}, {1, 1, 1}}), (Crossings{1, 1, false}));          // the corner
  EXPECT_EQ(crossings({{1, 1, 1}, {0, 1, 1}}), (Crossings{1, 1, false}));          // an outer edge
  EXPECT_EQ(crossings({{-1, 0, 1}, {1, 0, 0}}).count % 2, 0u);                     // along a face
  EXPECT_EQ(crossings({{-1, 0, 0}, {1, 0, 0}}).count % 2, 0u);  // along an outer edge
  EXPECT_EQ(crossings({{-2, 1, 1}, {1, 1, 1}}).signed_count, 0);
  EXPECT_TRUE(crossings({{0, 1, 1}, {1, 0, 0}}).origin_on_surface);
  // The shift (e, e^2, e^3) moves a point of the face x = 0 inside, one of the face x = 2 outside.
  EXPECT_EQ(crossings({{0, 1, 1}, {1, 0, 0}}), (Crossings{1, 1, true}));
  EXPECT_EQ(crossings({{2, 1, 1}, {1, 0, 0}}), (Crossings{0, 0, true}));
  EXPECT_EQ(crossings({{2, 1, 1}, {-1, 0, 0}}), (Crossings{2, 0, true}));
}

}  // namespace
}  // namespace pierce
