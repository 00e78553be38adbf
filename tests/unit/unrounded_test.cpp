// SPDX-License-Identifier: Apache-2.0
//
// Signs that double arithmetic came to without rounding, against numbers of any size: whatever is
// known is right, and on a grid all of it is known.
#include "predicate/unrounded.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "predicate/determinants.h"
#include "support/dyadic.h"
#include "support/rng.h"
#include "support/run_cases.h"

namespace pierce::predicate {
namespace {

using hard::Rng;
using oracle::Dyadic;

Triple<Dyadic> exactly(const Vec3<double>& p) { return {Dyadic(p.x), Dyadic(p.y), Dyadic(p.z)}; }

struct Signs {
  int u, v, w;
};

Signs true_signs(const RayD& ray, const TriangleD& t) {
  const auto a = exactly(t.a);
  const auto s = a - exactly(ray.origin), e1 = exactly(t.b) - a, e2 = exactly(t.c) - a;
  const auto value = determinants_of(s, e1, e2, exactly(ray.direction));
  return {value.u.sign(), value.v.sign(), value.w.sign()};
}

// Returns how many of the three are known; those have to be right.
int check(const RayD& ray, const TriangleD& t) {
  const UnroundedSigns signs(ray, t);
  const Signs truth = true_signs(ray, t);
  EXPECT_TRUE(!signs.known_u || signs.u == truth.u);
  EXPECT_TRUE(!signs.known_v || signs.v == truth.v);
  EXPECT_TRUE(!signs.known_w || signs.w == truth.w);
  return (signs.known_u ? 1 : 0) + (signs.known_v ? 1 : 0) + (signs.known_w ? 1 : 0);
}

// Whole numbers of up to so many bits each, times a power of two.
Vec3<double> whole(Rng& rng, int bits, int place) {
  const auto number = [&] {
    const auto size = static_cast<double>(rng.bits() >> (64 - bits));
    return std::ldexp(rng.coin() ? size : -size, place);
  };
  return {number(), number(), number()};
}

Vec3<double> middle(const Vec3<double>& p, const Vec3<double>& q) {
  return {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
}
Vec3<double> from_to(const Vec3<double>& p, const Vec3<double>& q) {
  return {q.x - p.x, q.y - p.y, q.z - p.z};
}

TEST(Unrounded, what_is_known_is_right) {
  int known = 0, all = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed(), i);
    const auto bits = [&] { return rng.between(1, rng.coin() ? 14 : 53); };
    const auto place = [&] { return rng.one_in(8) ? rng.between(-140, 90) : 0; };
    TriangleD t{whole(rng, bits(), place()), whole(rng, bits(), place()),
                whole(rng, bits(), place())};
    RayD ray{whole(rng, bits(), place()), whole(rng, bits(), place())};
    // At a corner or the middle of an edge, so that a weight is zero, or nearly.
    const int aim = rng.between(0, 3);
    if (aim == 1) ray.direction = from_to(ray.origin, t.b);
    if (aim == 2) ray.direction = from_to(ray.origin, middle(t.a, t.c));
    if (aim == 3) ray.direction = from_to(ray.origin, middle(t.b, t.c));
    if (rng.one_in(4)) ray.direction.x = ray.direction.y = 0;
    known += check(ray, t);
    all += 3;
  }
  EXPECT_GT(known, all / 8);
  EXPECT_LT(known, all);
}

TEST(Unrounded, on_a_grid_everything_is_known) {
  for (std::uint64_t i = 0; i < hard::case_count(2000); ++i) {
    Rng rng(hard::seed() + 1, i);
    const int place = rng.between(-40, 40);
    const TriangleD t{whole(rng, 7, place), whole(rng, 7, place), whole(rng, 7, place)};
    const RayD ray{whole(rng, 7, place), whole(rng, 7, rng.between(-40, 40))};
    EXPECT_EQ(check(ray, t), 3);
  }
}

// Heights of any number of bits do not matter to what is looked at from above.
TEST(Unrounded, from_above_heights_do_not_matter) {
  for (std::uint64_t i = 0; i < hard::case_count(2000); ++i) {
    Rng rng(hard::seed() + 2, i);
    TriangleD t{whole(rng, 10, -2), whole(rng, 10, -2), whole(rng, 10, -2)};
    for (Vec3<double>* p : {&t.a, &t.b, &t.c}) p->z = rng.symmetric();
    RayD ray{t.b, {0, 0, -1}};
    ray.origin.z = 100.1;
    EXPECT_EQ(check(ray, t), 3);
  }
}

// Through a corner, in whatever direction: the other two may have any number of bits.
TEST(Unrounded, through_a_corner_its_edges_are_known) {
  for (std::uint64_t i = 0; i < hard::case_count(2000); ++i) {
    Rng rng(hard::seed() + 3, i);
    TriangleD t{whole(rng, 25, -24), whole(rng, 25, -24), whole(rng, 25, -24)};
    RayD ray{whole(rng, 25, -24), {0, 0, 0}};
    const Vec3<double>* corners[3] = {&t.a, &t.b, &t.c};
    const int through = rng.between(0, 2);
    ray.direction = from_to(ray.origin, *corners[through]);
    const UnroundedSigns signs(ray, t);
    check(ray, t);
    EXPECT_TRUE(through == 0 || (signs.known_w && signs.w == 0));
    EXPECT_TRUE(through == 1 || (signs.known_u && signs.u == 0));
    EXPECT_TRUE(through == 2 || (signs.known_v && signs.v == 0));
  }
}

TEST(Unrounded, of_tiny_components_nothing_is_known) {
  const TriangleD t{{0, 0, 0}, {1, 0, 0x1p-600}, {0, 1, 0}};
  EXPECT_EQ(check(RayD{{0.25, 0.25, 1}, {0, 0x1p-600, -1}}, t), 0);
  // The product of two such would be lost without a trace: V is 2^-1200 here.
  const TriangleD edge{{1, 0x1p-600, 0}, {0, 0, 1}, {0, 1, -3}};
  check(RayD{{0, 0, 0}, {0x1p-600, 0, -1}}, edge);
}

}  // namespace
}  // namespace pierce::predicate
