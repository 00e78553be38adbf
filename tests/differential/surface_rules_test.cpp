// SPDX-License-Identifier: Apache-2.0
//
// Surfaces that are closed though not every edge has a partner, and faces that are there twice: the
// same answers as of the same set of points in better order.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "pierce/scene.h"
#include "support/brute_force.h"
#include "support/closed_meshes.h"
#include "support/located.h"
#include "support/run_cases.h"
#include "support/shapes.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::located;
using hard::Mesh;
using hard::Rng;

// Between two vertices, one of them, or level with vertices in every coordinate.
template <class Real>
Vec3<Real> hard_point(Rng& rng, const Mesh<Real>& mesh) {
  const auto vertex = [&] { return mesh.vertices[rng.below(mesh.vertices.size())]; };
  const Vec3<Real> p = vertex(), q = vertex(), r = vertex();
  switch (rng.below(3)) {
    case 0:
      return {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
    case 1:
      return p;
    default:
      return {p.x, q.y, r.z};
  }
}

template <class Real>
class SurfaceRules : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SurfaceRules, Reals);

// T-junctions: the same set of points, whichever triangles make it up.
TYPED_TEST(SurfaceRules, edges_that_are_split_on_one_side_only_leave_no_gap) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < 24; ++i) {
    Rng rng(hard::seed() + 31, i);
    Mesh<Real> whole = hard::boxes<Real>(rng, 2, 4);
    const Real scale = rng.pick({Real(1), Real(0x1p-100), Real(0x1p100)});
    for (auto& v : whole.vertices) v = {v.x * scale, v.y * scale, v.z * scale};
    Mesh<Real> split = whole;
    hard::split_on_one_side(rng, split, 30);
    std::vector<Vec3<Real>> points;
    for (int k = 0; k < 30; ++k) points.push_back(hard_point(rng, split));
    const auto one = Scene<Real>::build(whole.view());
    const auto other = Scene<Real>::build(split.view(), {.quality = Quality(rng.below(4))});
    const oracle::BruteForce<Real> truth(split.view());
    for (const auto& p : points) ASSERT_EQ(other.locate(p), truth.locate(p)) << show::text(p);
    for (const InsideRule rule : {InsideRule::Odd, InsideRule::NonZero}) {
      ASSERT_EQ(located(one, points, {.rule = rule}), located(other, points, {.rule = rule}));
    }
    // Off the line by the smallest step there is, away from the face's plane, and the gap is found.
    if (split.vertices.size() == whole.vertices.size()) continue;
    Mesh<Real> open = split;
    Vec3<Real>& moved = open.vertices.back();
    const Vec3<Real>& other_end = open.vertices[open.triangles.back()[1]];
    Real& away = moved.x == other_end.x ? moved.x : moved.y == other_end.y ? moved.y : moved.z;
    away = std::nextafter(away, std::numeric_limits<Real>::infinity());
    const auto leaking = Scene<Real>::build(open.view());
    EXPECT_THROW((void)leaking.locate(points[0]), Error);
  }
}

// Every face twice, back to back or not: `Unique` finds what one of them bounds.
TYPED_TEST(SurfaceRules, the_rule_unique_counts_each_position_once) {
  using Real = TypeParam;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    Rng rng(hard::seed() + 32);
    Mesh<Real> doubled = mesh;
    const bool back_to_back = rng.coin();
    for (const Triangle& t : mesh.triangles) {
      doubled.triangles.push_back(back_to_back ? Triangle{t[2], t[1], t[0]}
                                               : Triangle{t[1], t[2], t[0]});
      if (rng.one_in(5)) doubled.triangles.push_back(t);
    }
    std::vector<Vec3<Real>> points;
    for (int k = 0; k < 40; ++k) points.push_back(hard_point(rng, mesh));
    const auto once = Scene<Real>::build(mesh.view());
    const auto twice = Scene<Real>::build(doubled.view(), {.quality = Quality(rng.below(4))});
    const LocateOptions unique{.rule = InsideRule::Unique};
    const auto expected = located(once, points);
    ASSERT_EQ(located(twice, points, unique), expected) << name;
    ASSERT_EQ(located(once, points, unique), expected) << name << ": nothing to leave out";
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(twice.locate(points[i], unique), expected[i]) << name << show::text(points[i]);
      ASSERT_EQ(twice.signed_distance(points[i], unique), once.signed_distance(points[i]));
    }
  }
}

}  // namespace
}  // namespace pierce
