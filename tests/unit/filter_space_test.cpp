// SPDX-License-Identifier: Apache-2.0
//
// The transform into filter space, checked exactly: the new origin lies on the mapped line to
// within 2^-48, tau is where it should be to within 2^-50 or 2^-52 of itself, and a ray is only
// said to miss the box if its line does. Scenes and rays of every size and at every distance, up to
// the ends of double.
#include "space/filter_space.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/hard_numbers.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;
using Rational = mpq_class;
using Point = std::array<Rational, 3>;

Rational power_of_two(int exponent) {
  Rational x = 1;
  if (exponent >= 0) {
    mpq_mul_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return x;
}

std::array<double, 3> array_of(const Vec3<double>& p) { return {p.x, p.y, p.z}; }

struct Scene {
  Vec3<double> lower, upper;
  space::FilterSpace space;
  Point center;
  int exponent = 0;  // the map is x -> (x - center) 2^exponent

  Scene(const Vec3<double>& low, const Vec3<double>& high)
      : lower(low), upper(high), space(low, high) {
    // The documented centre: 0 for a box about the origin, else the middle as doubles have it.
    const auto l = array_of(low), h = array_of(high);
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, h[k] * 0.5 - l[k] * 0.5);
    std::array<double, 3> c;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool about = std::max(std::fabs(l[k]), std::fabs(h[k])) * 0.25 <= extent;
      c[k] = about ? 0.0 : l[k] * 0.5 + h[k] * 0.5;
      center[k] = Rational(c[k]);
    }
    const Vec3<double> middle = space.map({c[0], c[1], c[2]});
    EXPECT_EQ(middle, (Vec3<double>{0, 0, 0}));
    // tau = t 2^(exponent - 1) for a direction of size 1.
    exponent = space.transform({{c[0], c[1], c[2]}, {1, 0, 0}}).tau_exponent;
  }

  [[nodiscard]] Point map(const Vec3<double>& p) const {
    const auto x = array_of(p);
    Point q;
    for (std::size_t k = 0; k < 3; ++k)
      q[k] = (Rational(x[k]) - center[k]) * power_of_two(exponent);
    return q;
  }
};

// Whether the line o + x d meets the box [-1, 1]^3.
bool meets_box(const Point& o, const Point& d) {
  bool bounded = false;
  Rational low, high;
  for (std::size_t k = 0; k < 3; ++k) {
    if (d[k] == 0) {
      if (abs(o[k]) > 1) return false;
      continue;
    }
    Rational from = (-1 - o[k]) / d[k], to = (1 - o[k]) / d[k];
    if (from > to) std::swap(from, to);
    low = bounded ? std::max(low, from) : from;
    high = bounded ? std::min(high, to) : to;
    bounded = true;
  }
  return low <= high;
}

struct Seen {
  int kept = 0, moved = 0, exactly = 0, misses = 0;
};

void check(const Scene& scene, const predicate::RayD& ray, Seen& seen) {
  const space::TransformedRay transformed = scene.space.transform(ray);
  const Point o = scene.map(ray.origin);
  // D = d 2^(exponent - tau_exponent), as tau = t 2^tau_exponent.
  const auto raw = array_of(ray.direction);
  Point d;
  Rational largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    d[k] = Rational(raw[k]) * power_of_two(scene.exponent - transformed.tau_exponent);
    largest = std::max(largest, Rational(abs(d[k])));
  }
  ASSERT_GE(largest, 1);
  ASSERT_LT(largest, 2);
  (transformed.exactly ? seen.exactly : transformed.origin_kept ? seen.kept : seen.moved) += 1;
  if (transformed.misses) {
    ++seen.misses;
    ASSERT_FALSE(meets_box(o, d));
    return;
  }
  const auto direction = array_of(transformed.direction), origin = array_of(transformed.origin);
  const Rational tiny = power_of_two(-1074);
  Rational dd = 0, od = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_LE(abs(Rational(direction[k]) - d[k]), tiny);
    ASSERT_LE(
        std::fabs(origin[k]),
        static_cast<double>(transformed.origin_kept ? space::kKeptOrigin : space::kNearOrigin));
    dd += d[k] * d[k];
    od += o[k] * d[k];
  }
  const Rational shift = transformed.exactly ? Rational(-od / dd) : Rational(transformed.tau_shift);
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_LE(abs(Rational(origin[k]) - (o[k] + shift * d[k])), power_of_two(-48));
  }
  const auto near = [&](double tau, double t) {
    Rational truth = std::isinf(t)
                         ? Rational(t > 0 ? 100 : -100)
                         : Rational(Rational(t) * power_of_two(transformed.tau_exponent) - shift);
    const Rational limit(static_cast<double>(space::kTauLimit));
    truth = std::clamp(truth, Rational(-limit), limit);
    return abs(Rational(tau) - truth) <=
           std::max(power_of_two(-50), Rational(abs(truth) * power_of_two(-52)));
  };
  ASSERT_TRUE(near(transformed.tau_min, ray.t_min));
  ASSERT_TRUE(near(transformed.tau_max, ray.t_max));
  if (!transformed.exactly) {
    ASSERT_TRUE(near(transformed.tau(ray.t_min), ray.t_min));
  }
}

std::string text(const Scene& scene, const predicate::RayD& ray) {
  return show::text(scene.lower) + " .. " + show::text(scene.upper) + " from " +
         show::text(ray.origin) + " along " + show::text(ray.direction);
}

Scene draw_scene(Rng& rng) {
  const hard::Style style = rng.pick(hard::kAllStyles);
  Vec3<double> p = hard::vec<double>(rng, style), q = hard::vec<double>(rng, style);
  if (rng.one_in(3)) {  // far away and small
    const double size = std::ldexp(1.0, -rng.between(0, 50));
    q = {p.x * (1 + size), p.y * (1 + size * rng.unit()), p.z * (1 - size)};
    if (!hard::is_finite(q)) q = p;
  }
  return Scene({std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
               {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)});
}

// Towards the box, mostly: from a point of it, out along the direction, by any distance.
predicate::RayD draw_ray(Rng& rng, const Scene& scene) {
  predicate::RayD ray;
  do {
    const hard::Style style = rng.pick(hard::kAllStyles);
    ray.direction = hard::vec<double>(rng, rng.coin() ? hard::Style::Unit : style);
    if (rng.coin()) {
      ray.origin = hard::vec<double>(rng, style);
    } else {
      const double size = std::max({scene.upper.x - scene.lower.x, scene.upper.y - scene.lower.y,
                                    scene.upper.z - scene.lower.z});
      const double far = std::ldexp(size, rng.between(-3, 60));
      const auto at = [&](double low, double high, double d) {
        return low + (high - low) * (1.5 * rng.unit() - 0.25) + far * d;
      };
      ray.origin = {at(scene.lower.x, scene.upper.x, ray.direction.x),
                    at(scene.lower.y, scene.upper.y, ray.direction.y),
                    at(scene.lower.z, scene.upper.z, ray.direction.z)};
    }
  } while (!hard::is_valid(Ray<double>{ray.origin, ray.direction}));
  ray.t_min = rng.coin() ? 0 : hard::number<double>(rng, rng.pick(hard::kAllStyles));
  ray.t_max = rng.coin() ? kInfinity<double> : hard::number<double>(rng, hard::Style::Unit);
  return ray;
}

TEST(FilterSpaceTransform, every_ray_is_transformed_to_within_the_bounds) {
  Seen seen;
  const std::uint64_t count = hard::case_count(30000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 95, i);
    const Scene scene = draw_scene(rng);
    const predicate::RayD ray = draw_ray(rng, scene);
    check(scene, ray, seen);
    ASSERT_FALSE(HasFailure()) << "case " << i << ": " << text(scene, ray);
  }
  if (hard::enough_cases(30000)) {
    EXPECT_GT(seen.kept, 100);
    EXPECT_GT(seen.moved, 1000);
    EXPECT_GT(seen.exactly, 1000);
    EXPECT_GT(seen.misses, 1000);
  }
}

TEST(FilterSpaceTransform, rays_beside_the_largest_double_are_transformed) {
  // The two-term sum of the origin's distance overflows on the way, although the distance does not.
  const double largest = std::numeric_limits<double>::max();
  const Scene scene({largest, -0x1p1021, -0x1p1021}, {largest, 0x1p1021, 0x1p1021});
  Seen seen;
  for (const double x : {0x1.8p971, -0x1.8p971, 0.0, 0x1p1000, -0x1p1023, -largest}) {
    for (const double y : {0.0, 0x1p-3, -0x1p-60}) {
      const predicate::RayD ray{{x, 0x1p1019, 0}, {1, y, 0}, 0, kInfinity<double>};
      check(scene, ray, seen);
      ASSERT_FALSE(HasFailure()) << text(scene, ray);
    }
  }
  EXPECT_EQ(seen.misses, 0);
  EXPECT_GT(seen.exactly, 0);
}

// Lines that pass the box's corners, as seen from the edge of what double can transform.
TEST(FilterSpaceTransform, no_line_that_meets_the_box_is_said_to_miss_it) {
  Seen seen;
  const Scene scene({-1, -1, -1}, {1, 1, 1});
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 96, i);
    const auto sign = [&] { return rng.coin() ? 1.0 : -1.0; };
    const Vec3<double> corner{sign(), sign(), sign()};
    const Vec3<double> along{rng.symmetric(), rng.symmetric(), rng.symmetric()};
    // At a right angle to the corner's direction the line passes as far away as it can.
    const double lean = (along.x * corner.x + along.y * corner.y + along.z * corner.z) / 3;
    const Vec3<double> d{along.x - lean * corner.x, along.y - lean * corner.y,
                         along.z - lean * corner.z};
    const double far = std::ldexp(sign() * (1 + rng.unit()), rng.between(0, 51));
    const predicate::RayD ray{{corner.x + far * d.x, corner.y + far * d.y, corner.z + far * d.z},
                              d};
    if (!hard::is_valid(Ray<double>{ray.origin, ray.direction})) continue;
    check(scene, ray, seen);
    ASSERT_FALSE(HasFailure()) << text(scene, ray);
  }
  if (hard::enough_cases(20000)) {
    EXPECT_GT(seen.moved, 1000);
  }
}

}  // namespace
}  // namespace pierce
