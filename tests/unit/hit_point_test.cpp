// SPDX-License-Identifier: Apache-2.0
//
// The sides of planes and the ways that next_origin asks for, where double-doubles cannot tell:
// points that lie in a plane without being corners, and the nearest ones that do not, against
// rationals over GMP.
#include "predicate/hit_point.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pierce/vector.h"
#include "support/hard_cases.h"
#include "support/rng.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;
using Exact = Vec3<mpq_class>;

// Whole numbers of up to 51 bits: sums of three are exact.
Vec3<double> whole(Rng& rng) {
  const auto number = [&rng] { return std::nearbyint(std::ldexp(rng.symmetric(), 51)); };
  return {number(), number(), number()};
}

Exact exact(const Vec3<double>& p) { return {p.x, p.y, p.z}; }

int sign_along(const predicate::TriangleD& t, const Exact& way) {
  const Exact a = exact(t.a);
  return sgn(dot(cross(exact(t.b) - a, exact(t.c) - a), way));
}

int true_side(const Vec3<double>& s, const predicate::TriangleD& t) {
  return sign_along(t, exact(s) - exact(t.a));
}

// The fourth corner of a parallelogram, in the plane of the other three; or one unit beside it.
Vec3<double> near_plane(Rng& rng, const Vec3<double>& p, const Vec3<double>& q,
                        const Vec3<double>& opposite) {
  Vec3<double> s = p + q - opposite;
  if (rng.coin()) hard::component(s, rng.below(3)) += rng.coin() ? 1 : -1;
  return s;
}

TEST(HitPoint, the_side_of_a_plane_is_exact_for_points_in_it_and_next_to_it) {
  std::uint64_t in_plane = 0, beside = 0;
  const std::uint64_t count = hard::case_count(20000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 580, i);
    const predicate::TriangleD t{whole(rng), whole(rng), whole(rng)};
    const Vec3<double> s = near_plane(rng, t.b, t.c, t.a);
    const int truth = true_side(s, t);
    ASSERT_EQ(predicate::decide_side(s, t), truth) << i << show::text(s) << show::text(t.a);
    ++(truth == 0 ? in_plane : beside);
  }
  if (hard::enough_cases(20000)) {
    EXPECT_GT(in_plane, count / 4);
    EXPECT_GT(beside, count / 4);
  }
}

// X is the middle of an edge. Where it lies in the other plane, the side is that to which the ray
// leads.
TEST(HitPoint, the_way_past_a_plane_through_the_hit_is_exact) {
  std::uint64_t through = 0, beside = 0;
  const std::uint64_t count = hard::case_count(20000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 581, i);
    const Vec3<double> x = whole(rng), half = whole(rng), d = whole(rng);
    const predicate::TriangleD t{whole(rng), x + half, x - half};
    const predicate::RayD ray{x - d, d};
    predicate::TriangleD other{whole(rng), whole(rng), {}};
    other.c = near_plane(rng, other.a, other.b, x);
    for (const Side side : {Side::Before, Side::Beyond}) {
      const predicate::HitPoint hit(ray, t, side);
      int truth = true_side(x, other);
      ++(truth == 0 ? through : beside);
      if (truth == 0) truth = sign_along(other, exact(hit.towards));
      ASSERT_EQ(predicate::decide_way(hit, other), truth) << i;
    }
  }
  if (hard::enough_cases(20000)) {
    EXPECT_GT(through, count / 4);
    EXPECT_GT(beside, count / 4);
  }
}

}  // namespace
}  // namespace pierce
