// SPDX-License-Identifier: Apache-2.0
//
// Lines exactly through corners, against numbers of any size: whatever is known is right, and of
// rays that start at a corner, or aim at one from the origin, all of it is known.
#include "predicate/corner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "predicate/settle.h"
#include "support/any_numbers.h"
#include "support/dyadic.h"
#include "support/rng.h"
#include "support/run_cases.h"

namespace pierce::predicate {
namespace {

using hard::neighbour;
using hard::number;
using hard::point;
using hard::Rng;
using oracle::Dyadic;

Vec3<double> times(double s, const Vec3<double>& p) { return {s * p.x, s * p.y, s * p.z}; }
Vec3<double> plus(const Vec3<double>& p, const Vec3<double>& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}

// A ray at, or just beside, one of the triangle's corners; sometimes exactly.
RayD aimed(const Vec3<double>& corner, Rng& rng) {
  RayD ray{point(rng), point(rng)};
  switch (rng.between(0, 4)) {
    case 0:  // starts there
      ray.origin = corner;
      break;
    case 1:  // from 0
      ray.origin = {0, 0, 0};
      ray.direction = times(std::ldexp(rng.coin() ? 1 : -1, rng.between(-3, 3)), corner);
      break;
    case 2:  // where differences are rounded
      ray.direction = plus(corner, times(-1, ray.origin));
      break;
    case 3:  // any factor
      ray.origin = plus(corner, times(number(rng), ray.direction));
      break;
    default:
      ray.origin = plus(corner, times(rng.between(-40, 40), ray.direction));
  }
  if (rng.one_in(5)) ray.direction.y = neighbour(ray.direction.y, rng);
  if (rng.one_in(9)) ray.origin.z = neighbour(ray.origin.z, rng);
  return ray;
}

bool is_valid(const RayD& ray, const TriangleD& t) {
  const auto finite = [](const Vec3<double>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  return finite(ray.origin) && finite(ray.direction) && finite(t.a) && finite(t.b) && finite(t.c) &&
         (ray.direction.x != 0 || ray.direction.y != 0 || ray.direction.z != 0);
}

Triple<Dyadic> exactly(const Vec3<double>& p) { return {Dyadic(p.x), Dyadic(p.y), Dyadic(p.z)}; }

TEST(Corner, a_place_on_the_line_is_the_true_one) {
  int found = 0, on_line = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed(), i);
    const Vec3<double> p = point(rng);
    const RayD ray = aimed(p, rng);
    if (!is_valid(ray, {p, p, p})) continue;
    const auto away = exactly(p) - exactly(ray.origin), d = exactly(ray.direction);
    const auto across = cross(away, d);
    const bool truly = across.x.sign() == 0 && across.y.sign() == 0 && across.z.sign() == 0;
    on_line += truly ? 1 : 0;
    const auto place = place_on_line(ray, p);
    if (!place) continue;
    ++found;
    EXPECT_TRUE(truly);
    const Dyadic numerator(place->numerator), denominator(place->denominator);
    EXPECT_NE(denominator.sign(), 0);
    EXPECT_EQ(compare(away.x * denominator, numerator * d.x), 0);
    EXPECT_EQ(compare(away.y * denominator, numerator * d.y), 0);
    EXPECT_EQ(compare(away.z * denominator, numerator * d.z), 0);
  }
  EXPECT_GT(found, on_line * 9 / 10);
  EXPECT_LT(found, on_line);
}

TriangleD turned(const TriangleD& t, int by) {
  return by == 0 ? t : by == 1 ? TriangleD{t.b, t.c, t.a} : TriangleD{t.c, t.a, t.b};
}

template <class Real>
void check_numbers(const RayD& ray, const TriangleD& t, std::uint8_t zeros, const Filtered& f) {
  const auto hit = round_at_corner<Real>(ray, t, zeros, f);
  if (!hit) return;
  const Hit<Real> truth = settle_numbers<Real>(ray, t);
  EXPECT_EQ(hit->t, truth.t);
  EXPECT_EQ(std::signbit(hit->t), std::signbit(truth.t));
  EXPECT_EQ(hit->u, truth.u);
  EXPECT_EQ(hit->v, truth.v);
  EXPECT_EQ(hit->w, truth.w);
  EXPECT_EQ(hit->facing, truth.facing);
}

TEST(Corner, what_is_known_of_a_hit_is_right) {
  int hits = 0, misses = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 2, i);
    TriangleD t{point(rng), point(rng), point(rng)};
    if (rng.one_in(20)) t.c = t.b;
    t = turned(t, rng.between(0, 2));
    RayD ray = aimed(t.a, rng);
    t = turned(t, rng.between(0, 2));
    if (!is_valid(ray, t)) continue;
    if (rng.one_in(3)) {  // an end of the range there, or beside it
      const Settled anywhere = settle_hit({ray.origin, ray.direction, -kInfinity<double>}, t);
      if (!anywhere.hit) continue;
      double end = settle_numbers<double>(ray, t).t;
      if (rng.one_in(3)) end = neighbour(end, rng);
      (rng.coin() ? ray.t_min : ray.t_max) = end;
      if (!(ray.t_min <= ray.t_max)) continue;
    }
    ray.open_start = rng.one_in(3);
    const Filtered f = filter_determinants(ray, t);
    const auto corner = meet_corner(ray, t, f);
    if (!corner) continue;
    const Settled truth = settle_hit(ray, t);
    EXPECT_EQ(corner->hit, truth.hit);
    ++(truth.hit ? hits : misses);
    if (!truth.hit) continue;
    EXPECT_EQ(corner->zeros, truth.zeros);
    EXPECT_EQ(corner->facing, truth.facing);
    const auto compare_to_t = [&](double bound) {  // the sign of t - bound
      RayD from = ray;
      from.t_min = bound;
      from.t_max = kInfinity<double>;
      from.open_start = false;
      return settle_hit(from, t).hit;
    };
    EXPECT_TRUE(compare_to_t(corner->t.low));
    EXPECT_TRUE(corner->t.high == 0 || !compare_to_t(corner->t.high));
    check_numbers<float>(ray, t, truth.zeros, f);
    check_numbers<double>(ray, t, truth.zeros, f);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 500);
}

// Whatever the numbers, as long as the line crosses the plane and the products do not underflow.
TEST(Corner, of_rays_from_a_corner_or_from_0_to_it_all_is_known) {
  for (std::uint64_t i = 0; i < hard::case_count(4000); ++i) {
    Rng rng(hard::seed() + 3, i);
    const auto anywhere = [&] { return Vec3<double>{rng.symmetric(), rng.symmetric(), 1}; };
    const TriangleD t{anywhere(), plus(anywhere(), {4, 0, 0}), plus(anywhere(), {0, 4, 0})};
    const Vec3<double>& p = t.corner(rng.between(0, 2));
    const bool starts = rng.coin();
    RayD ray{{0, 0, 0}, p};
    if (starts) ray = {p, {rng.symmetric(), rng.symmetric(), rng.coin() ? 1.0 : -1.0}};
    const Filtered f = filter_determinants(ray, t);
    const auto corner = meet_corner(ray, t, f);
    ASSERT_TRUE(corner);
    EXPECT_TRUE(corner->hit);
    const auto hit = round_at_corner<double>(ray, t, corner->zeros, f);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, starts ? 0 : 1);
    EXPECT_TRUE(round_at_corner<float>(ray, t, corner->zeros, f));
  }
}

// t lies beside the middle of two floats, so close that double may not tell.
TEST(Corner, t_is_rounded_once) {
  int known = 0;
  const int cases = static_cast<int>(hard::case_count(2000));
  for (int i = 0; i < cases; ++i) {
    Rng rng(hard::seed() + 4, static_cast<std::uint64_t>(i));
    const double middle = 1 + std::ldexp(1 + 2 * rng.between(0, 1 << 20), -24);
    const double speed = rng.between(1 << 20, 1 << 25);
    double along = middle * speed;
    for (int steps = rng.between(0, 3); steps > 0; --steps) along = neighbour(along, rng);
    const TriangleD t{{along, 0, 0}, {along + 1, 1, 0}, {along, 0, 1}};
    const RayD ray{{0, 0, 0}, {speed, 0, 0}};
    const Filtered f = filter_determinants(ray, t);
    known += round_at_corner<float>(ray, t, kZeroU | kZeroV, f) ? 1 : 0;
    check_numbers<float>(ray, t, kZeroU | kZeroV, f);
    check_numbers<double>(ray, t, kZeroU | kZeroV, f);
  }
  EXPECT_EQ(known, cases);
}

// Products that underflow say nothing: both of these are 0, and the corner is beside the line.
TEST(Corner, products_that_are_lost_are_not_equal) {
  const RayD ray{{0, 0, 0}, {0x1p-600, 0, 1}};
  EXPECT_FALSE(place_on_line({{0, 0, 0}, {0x1p-600, 0, 0x1p-500}}, {0x1p-601, 0, 0x1p-500}));
  EXPECT_FALSE(place_on_line(ray, {0x1p-1000, 0, 0x1p-300}));
  EXPECT_TRUE(place_on_line(ray, {0, 0, 0}));
}

}  // namespace
}  // namespace pierce::predicate
