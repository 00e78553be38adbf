// SPDX-License-Identifier: Apache-2.0
//
// What an axis makes simple, and the products and quotients that it leaves, against numbers of any
// size: whatever is known is right.
#include "predicate/axis_signs.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "predicate/determinants.h"
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

TEST(Quotient, a_quotient_is_compared_as_it_is) {
  int known = 0, equal = 0, all = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 1, i);
    Quotient t{number(rng), number(rng)};
    if (t.denominator == 0) continue;
    double bound = rng.one_in(3) ? number(rng) : t.numerator / t.denominator;
    if (rng.one_in(3)) bound = neighbour(bound, rng);
    if (rng.coin()) t.numerator = bound * t.denominator;
    if (!std::isfinite(bound) || !std::isfinite(t.numerator)) continue;
    const Dyadic denominator(t.denominator);
    const int truth =
        denominator.sign() * compare(Dyadic(t.numerator), Dyadic(bound) * denominator);
    ++all;
    equal += truth == 0 ? 1 : 0;
    if (const auto order = t.compare(bound)) {
      ++known;
      EXPECT_EQ(*order, truth);
    }
    EXPECT_EQ(t.compare(kInfinity<double>), -1);
    EXPECT_EQ(t.compare(-kInfinity<double>), 1);
  }
  EXPECT_GT(known, all * 8 / 10);
  EXPECT_GT(equal, all / 10);
}

// The numerator is the border between two floats times the denominator, as far as that is a double.
TEST(Quotient, next_to_the_border_of_two_floats_it_is_rounded_to_the_nearer) {
  int ties = 0, below = 0, above = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 9, i);
    const float low = static_cast<float>(std::ldexp(1 + rng.unit(), rng.between(-120, 120)));
    const float high = std::nextafter(low, kInfinity<float>);
    const double border = (static_cast<double>(low) + static_cast<double>(high)) / 2;
    double denominator = rng.symmetric();
    if (rng.one_in(4)) denominator = std::ldexp(rng.between(1, 1000), rng.between(-60, 60));
    if (denominator == 0) continue;
    const double side = rng.coin() ? 1 : -1;
    const Quotient t{side * border * denominator, denominator};
    const int truth = Dyadic(denominator).sign() *
                      compare(Dyadic(side * t.numerator), Dyadic(border) * Dyadic(denominator));
    (truth == 0 ? ties : truth < 0 ? below : above) += 1;
    const bool low_is_even = (std::bit_cast<std::uint32_t>(low) & 1) == 0;
    const float nearer = truth < 0 || (truth == 0 && low_is_even) ? low : high;
    EXPECT_EQ(t.rounded<float>(), static_cast<float>(side) * nearer);
  }
  EXPECT_GT(ties, 1000);
  EXPECT_GT(below, 1000);
  EXPECT_GT(above, 1000);
}

TEST(Quotient, products_are_compared_as_they_are) {
  int known = 0, equal = 0, all = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 5, i);
    const double a = number(rng), b = number(rng), c = number(rng);
    double d = rng.one_in(4) || c == 0 ? number(rng) : a * b / c;
    if (rng.one_in(4)) d = neighbour(d, rng);
    if (!std::isfinite(d)) continue;
    const double e = rng.one_in(3) ? b : c, f = rng.one_in(3) ? a : d;  // b a against a b
    const int truth = compare(Dyadic(a) * Dyadic(b), Dyadic(e) * Dyadic(f));
    ++all;
    equal += truth == 0 ? 1 : 0;
    const auto order = order_of_products(a, b, e, f);
    if (!order) continue;
    ++known;
    EXPECT_EQ(*order, truth);
  }
  EXPECT_GT(known, all * 9 / 10);
  EXPECT_LT(known, all);
  EXPECT_GT(equal, all / 20);
}

TEST(Quotient, products_that_are_lost_are_not_equal) {
  EXPECT_FALSE(order_of_products(0x1p-600, 0x1p-600, 0, 1));
  EXPECT_FALSE(order_of_products(0x1p-600, 0x1p-600, 0x1p-601, 0x1p-600));
  EXPECT_EQ(order_of_products(0, 0x1p-600, 0x1p-601, 0), 0);
  EXPECT_EQ(order_of_products(0x1p600, 0x1p600, 1, 1), 1);
}

// What stands across an axis, and a ray that moves along it, straight or not.
struct Floor {
  RayD ray;
  TriangleD triangle;
};
Floor floor_of(Rng& rng) {
  Vec3<double> p[3] = {point(rng), point(rng), point(rng)};
  RayD ray{point(rng), point(rng)};
  const int axis = rng.between(0, 2);
  const auto of = [axis](Vec3<double>& v) -> double& {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
  };
  of(p[1]) = of(p[2]) = of(p[0]);
  if (rng.one_in(3)) of(ray.origin) = rng.coin() ? of(p[0]) : neighbour(of(p[0]), rng);
  if (rng.coin()) of(ray.direction) = rng.coin() ? 1 : -2;
  return {ray, {p[0], p[1], p[2]}};
}
bool is_finite(const Vec3<double>& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
bool is_valid(const RayD& ray, const TriangleD& t) {
  return is_finite(ray.origin) && is_finite(ray.direction) && is_finite(t.a) && is_finite(t.b) &&
         is_finite(t.c);
}

TEST(AcrossAxis, t_is_the_true_one) {
  int places = 0, hits = 0, rounded = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 6, i);
    auto [ray, t] = floor_of(rng);
    if (rng.coin()) {  // at the middle of it
      ray.direction.x = (t.a.x + t.b.x + t.c.x) / 3 - ray.origin.x;
      ray.direction.y = (t.a.y + t.b.y + t.c.y) / 3 - ray.origin.y;
      ray.direction.z = (t.a.z + t.b.z + t.c.z) / 3 - ray.origin.z;
    }
    if (!is_valid(ray, t)) continue;
    ray.open_start = rng.one_in(3);
    if (const auto place = place_across_axis(ray, t)) {
      ++places;
      if (rng.coin()) ray.t_min = place->numerator / place->denominator;
      if (rng.one_in(3)) ray.t_min = neighbour(ray.t_min, rng);
      if (!std::isfinite(ray.t_min)) continue;
      const Settled line = settle_hit({ray.origin, ray.direction, -kInfinity<double>}, t);
      const Settled truth = settle_hit(ray, t);
      const auto in_range = place->in_range(ray);
      if (line.hit && in_range) {
        EXPECT_EQ(*in_range, truth.hit);
      }
    }
    if (!settle_hit({ray.origin, ray.direction, -kInfinity<double>}, t).hit) continue;
    ++hits;
    const auto exactly_double = settle_numbers<double>(ray, t).t;
    const auto exactly_float = settle_numbers<float>(ray, t).t;
    if (const auto found = round_across_axis<double>(ray, t)) {
      ++rounded;
      EXPECT_EQ(*found, exactly_double);
      EXPECT_EQ(std::signbit(*found), std::signbit(exactly_double));
    }
    if (const auto found = round_across_axis<float>(ray, t)) {
      EXPECT_EQ(*found, exactly_float);
      EXPECT_EQ(std::signbit(*found), std::signbit(exactly_float));
    }
  }
  EXPECT_GT(places, 5000);
  EXPECT_GT(hits, 2000);
  EXPECT_GT(rounded, hits / 2);
}

TEST(AlongAxis, signs_are_the_true_ones) {
  int known = 0, all = 0, zeros = 0, weights = 0, weights_set = 0;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 7, i);
    TriangleD t{point(rng), point(rng), point(rng)};
    RayD ray{point(rng), {0, 0, 0}};
    if (rng.one_in(3)) ray.origin = t.b;
    if (rng.one_in(3)) ray.origin = {(t.a.x + t.c.x) / 2, (t.a.y + t.c.y) / 2, (t.a.z + t.c.z) / 2};
    if (rng.one_in(8)) ray.origin.y = neighbour(ray.origin.y, rng);
    double speed = number(rng);
    if (rng.one_in(8)) speed = std::ldexp(speed, -1060);  // t is beyond all doubles
    (rng.one_in(3) ? ray.direction.x : rng.coin() ? ray.direction.y : ray.direction.z) = speed;
    if (speed == 0 || !is_valid(ray, t)) continue;
    ++all;
    const auto signs = look_along_axis(ray, t);
    if (!signs) continue;
    ++known;
    const RayD line{ray.origin, ray.direction, -kInfinity<double>};
    const Settled truth = settle_hit(line, t);
    EXPECT_EQ(signs->den() != 0, truth.hit);
    if (truth.hit) {
      Hit<double> rounded;
      const auto wanted = static_cast<std::uint8_t>(rng.below(16));
      const auto numbers = settle_numbers<double>(ray, t);
      const std::uint8_t set = round_along_axis(ray, t, wanted, rounded);
      EXPECT_EQ(set & ~wanted, 0);
      weights += __builtin_popcount(wanted & ~1U);
      weights_set += __builtin_popcount(set);
      EXPECT_TRUE((set & kNumberU) == 0 || rounded.u == numbers.u);
      EXPECT_TRUE((set & kNumberV) == 0 || rounded.v == numbers.v);
      EXPECT_TRUE((set & kNumberW) == 0 || rounded.w == numbers.w);
      EXPECT_EQ(signs->den() < 0 ? Facing::Front : Facing::Back, truth.facing);
      const auto hits = [&](double from, double to) {
        return settle_hit({ray.origin, ray.direction, from, to}, t).hit;
      };
      EXPECT_LE(signs->t.low, signs->t.high);
      EXPECT_TRUE(hits(signs->t.low, signs->t.high));
    }
    const auto of = [](const Vec3<double>& p) {
      return Triple<Dyadic>{Dyadic(p.x), Dyadic(p.y), Dyadic(p.z)};
    };
    const auto value = determinants_of(of(t.a) - of(ray.origin), of(t.b) - of(t.a),
                                       of(t.c) - of(t.a), of(ray.direction));
    EXPECT_EQ(signs->u, value.u.sign());
    EXPECT_EQ(signs->v, value.v.sign());
    EXPECT_EQ(signs->w, value.w.sign());
    zeros += signs->u == 0 || signs->v == 0 || signs->w == 0 ? 1 : 0;
  }
  EXPECT_GT(known, all / 10);
  EXPECT_LT(known, all);
  EXPECT_GT(zeros, known / 20);
  EXPECT_GT(weights_set, weights / 3);
  EXPECT_FALSE(look_along_axis({{0, 0, 0}, {1, 1, 0}}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace pierce::predicate
