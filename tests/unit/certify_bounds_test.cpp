// SPDX-License-Identifier: Apache-2.0
//
// The bounds of the double rung, attacked: the true determinants, from integers, must lie within
// the bounds, for cases that are drawn and then climb towards the largest error; and what the rung
// claims (yes, no, an interval of t) must be true.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "predicate/certify.h"
#include "predicate/decide.h"
#include "predicate/settle.h"
#include "support/hard_cases.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;
using Rational = mpq_class;
using Exact = predicate::Triple<Rational>;

Exact exact(const Vec3<double>& p) { return {Rational(p.x), Rational(p.y), Rational(p.z)}; }
Rational dot_of(const Exact& p, const Exact& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
Exact cross_of(const Exact& p, const Exact& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
Exact less(const Exact& p, const Exact& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

struct Errors {
  double den, u, v, w, t;  // in units of their bounds
  [[nodiscard]] double largest() const { return std::max({den, u, v, w, t}); }
};

struct Case {
  predicate::RayD ray;
  predicate::TriangleD triangle;
};

Errors errors_of(const Case& c, const predicate::Filtered& f) {
  const Exact a = exact(c.triangle.a);
  const Exact s = less(a, exact(c.ray.origin));
  const Exact e1 = less(exact(c.triangle.b), a);
  const Exact e2 = less(exact(c.triangle.c), a);
  const Exact d = exact(c.ray.direction);
  const Exact n = cross_of(e1, e2);
  const Exact r = cross_of(d, s);
  const Rational den = dot_of(n, d), u = -dot_of(r, e2), v = dot_of(r, e1), t = dot_of(n, s);
  const Rational w = den - u - v;
  const auto ratio = [](double value, const Rational& truth, double err) {
    const Rational off = abs(Rational(value) - truth) / Rational(err);
    return off.get_d();
  };
  return {ratio(f.value.den, den, f.den_err), ratio(f.value.u, u, f.uv_err),
          ratio(f.value.v, v, f.uv_err), ratio(f.value.w, w, f.w_err),
          ratio(f.value.t, t, f.t_err)};
}

double full(Rng& rng) {
  return rng.coin() ? 2 * rng.unit() - 1
                    : std::copysign(1 - rng.unit() * rng.unit() / 8, rng.symmetric());
}
Vec3<double> full_vec(Rng& rng) { return {full(rng), full(rng), full(rng)}; }

Case draw(Rng& rng) {
  Case c;
  c.ray.origin = full_vec(rng);
  c.ray.direction = full_vec(rng);
  c.triangle = {full_vec(rng), full_vec(rng), full_vec(rng)};
  return c;
}

Vec3<double>& vector_of(Case& c, std::uint64_t which) {
  switch (which) {
    case 0:
      return c.ray.origin;
    case 1:
      return c.ray.direction;
    case 2:
      return c.triangle.a;
    case 3:
      return c.triangle.b;
    default:
      return c.triangle.c;
  }
}

TEST(CertifyBounds, the_true_determinants_are_within_the_bounds) {
  Errors worst{};
  const std::uint64_t climbs = std::max<std::uint64_t>(hard::case_count(100000) / 1000, 1);
  for (std::uint64_t i = 0; i < climbs; ++i) {
    Rng rng(hard::seed() + 60, i);
    const double Errors::*aim =
        rng.pick(std::array{&Errors::den, &Errors::u, &Errors::v, &Errors::w, &Errors::t});
    Case best = draw(rng);
    double reached = 0;
    for (int step = 0; step < 250; ++step) {
      Case next = step < 20 ? draw(rng) : best;
      if (step >= 20) {
        double& x = hard::component(vector_of(next, rng.below(5)), rng.below(3));
        x = rng.one_in(3) ? full(rng) : x + std::ldexp(rng.symmetric(), -rng.between(4, 53));
      }
      const predicate::Filtered f = predicate::filter_determinants(next.ray, next.triangle);
      ASSERT_TRUE(f.usable);
      const Errors errors = errors_of(next, f);
      ASSERT_LE(errors.largest(), 1) << show::text(next.ray.origin) << show::text(next.triangle.a);
      if (errors.*aim >= reached) {
        reached = errors.*aim;
        best = next;
      }
      worst = {std::max(worst.den, errors.den), std::max(worst.u, errors.u),
               std::max(worst.v, errors.v), std::max(worst.w, errors.w),
               std::max(worst.t, errors.t)};
    }
  }
  if (hard::enough_cases(100000)) {
    // Even short climbs come this far.
    EXPECT_GT(worst.largest(), 0.15);
  }
}

// The proofs are about determinants.h, each number alone.
TEST(CertifyBounds, two_determinants_at_a_time_round_as_each_would_alone) {
  const std::uint64_t count = hard::case_count(20000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 63, i);
    const auto hard_case = hard::hard_case<double>(rng);
    const predicate::Triple<double> a = predicate::triple(hard_case.a);
    const predicate::Determinants<double, double> alone = predicate::determinants_of(
        a - predicate::triple(hard_case.ray.origin), predicate::triple(hard_case.b) - a,
        predicate::triple(hard_case.c) - a, predicate::triple(hard_case.ray.direction));
    const predicate::Filtered f =
        predicate::filter_determinants(predicate::to_double(hard_case.ray, hard_case.range),
                                       {hard_case.a, hard_case.b, hard_case.c});
    const auto same = [](double x, double y) { return x == y || (x != x && y != y); };
    ASSERT_TRUE(same(f.value.den, alone.den) && same(f.value.u, alone.u) &&
                same(f.value.v, alone.v) && same(f.value.w, alone.w) && same(f.value.t, alone.t))
        << show::text(hard_case);
  }
}

// Found by climbs of a hundred times the length: the largest errors we know. None is worth more
// than half its bound, for not all roundings can go wrong at once, but a quarter is not enough.
TEST(CertifyBounds, the_largest_known_errors_are_above_a_quarter_of_the_bounds) {
  struct Known {
    double Errors::*aim;
    Case c;
  };
  const Known known[] = {{&Errors::den,
                          {{{-0x1.987c2a6bc12e4p-2, 0x1.bc6b1f1dd0f9dp-1, -0x1.f44eb99cd5f29p-1},
                            {0x1.d0aa4b1804453p-1, -0x1.d2610fe60863ep-1, -0x1.d223119c9e353p-1}},
                           {{0x1.55a04ad0cd27bp-2, 0x1.fcf49e1b8dc15p-1, -0x1.afd84a2b6d43p-1},
                            {0x1.fe4701c3467f3p-1, 0x1.f7c711d5f0c0ep-1, -0x1.69e928e093f9p-6},
                            {-0x1.e70da085c9d92p-1, -0x1.e1500e111c4eep-1, 0x1.c76ebc408432bp-1}}}},
                         {&Errors::u,
                          {{{0x1.cf9c8d030824dp-1, -0x1.f14fba14a49bfp-1, -0x1.ebb50ee250ee1p-1},
                            {0x1.e93d306209d2cp-1, 0x1.f7452609e1c66p-1, -0x1.ed691b32ad9e6p-1}},
                           {{0x1.e0b3fd1260f48p-4, 0x1.873b0895381dcp-2, 0x1.0d19a77140abp-2},
                            {-0x1.0278a08c74954p-1, 0x1.d6b47237d44edp-1, -0x1.9819828c36aep-1},
                            {-0x1.ef1a427ea5884p-1, 0x1.ff5b05c7242fap-1, -0x1.a28b69758e4f9p-1}}}},
                         {&Errors::v,
                          {{{-0x1.c0385a562104p-1, -0x1.e6e5fea8f45f9p-1, -0x1.60fbc6d858d4ap-1},
                            {-0x1.ef4e4219aff12p-1, 0x1.e285aa10e113dp-1, 0x1.e95e1e38dfd5p-1}},
                           {{0x1.24bead17faea5p-1, 0x1.591667da91bfap-1, 0x1.e412d03550e03p-1},
                            {-0x1.eaa7bab1a367ap-1, -0x1.b5266bda35c27p-1, -0x1.13fd74540f98cp-1},
                            {0x1.e0c542f6effa3p-1, 0x1.f6b14967a831ap-1, 0x1.12ca8aa1a3075p-6}}}},
                         {&Errors::w,
                          {{{0x1.8cd3fa9d33514p-1, 0x1.e2c60139d7d3cp-1, 0x1.ff45bea7bacb7p-1},
                            {0x1.d55cccdda83a2p-1, 0x1.e5c336667bb53p-1, -0x1.e6e19603b2611p-1}},
                           {{0x1.91d461d11de9p-1, 0x1.b07757527f42bp-1, 0x1.ceea528a83559p-1},
                            {0x1.77a43b750704bp-1, -0x1.e970adf710112p-1, -0x1.d02ed54e237cp-1},
                            {-0x1.fbf2b23fdcb01p-1, 0x1.ab914341e5385p-1, -0x1.ae377f476904p-1}}}},
                         {&Errors::t,
                          {{{-0x1.f10a21bf29c09p-1, -0x1.fe2c5394f2b74p-1, 0x1.be9a6c19e05bbp-1},
                            {-0x1.c71f0ec5dab0fp-1, 0x1.f587a6fe92412p-1, 0x1.ff527eee21c93p-1}},
                           {{0x1.62cee9c0fded8p-5, -0x1.ef2ea8f25c96cp-3, -0x1.22b587f60fd08p-3},
                            {-0x1.e3a8fa013d377p-1, 0x1.8e7e61d98573ep-1, -0x1.ff5861768a6c4p-1},
                            {0x1.f3d12b8a691e8p-1, 0x1.e0fed081cf066p-1, 0x1.e2451af5ab7e3p-1}}}}};
  for (const Known& k : known) {
    const Errors errors = errors_of(k.c, filter_determinants(k.c.ray, k.c.triangle));
    EXPECT_LE(errors.largest(), 1);
    EXPECT_GT(errors.*k.aim, 0.25);
  }
}

TEST(CertifyBounds, what_is_claimed_is_true_of_hard_cases) {
  std::uint64_t yes = 0, no = 0, unsure = 0, intervals = 0;
  const std::uint64_t count = hard::case_count(100000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 61, i);
    const auto hard_case = hard::hard_case<double>(rng);
    const predicate::RayD ray = predicate::to_double(hard_case.ray, hard_case.range);
    const predicate::TriangleD triangle{hard_case.a, hard_case.b, hard_case.c};
    const predicate::Filtered f = predicate::filter_determinants(ray, triangle);
    const predicate::Certified claim = predicate::certify_hit(f, ray);
    if (claim == predicate::Certified::Unsure) {
      ++unsure;
    } else {
      const bool hit = predicate::settle_hit(ray, triangle).hit;
      ASSERT_EQ(claim == predicate::Certified::Yes, hit) << show::text(hard_case);
      ++(hit ? yes : no);
    }
    const predicate::Interval interval = predicate::t_interval(f);
    if (std::isinf(interval.low)) continue;
    // The true t is that of the line, hit or not.
    const Exact a = exact(triangle.a);
    const Exact n = cross_of(less(exact(triangle.b), a), less(exact(triangle.c), a));
    const Rational den = dot_of(n, exact(ray.direction));
    ASSERT_NE(den, 0) << show::text(hard_case);
    const Rational t = dot_of(n, less(a, exact(ray.origin))) / den;
    ASSERT_LE(Rational(interval.low), t) << show::text(hard_case);
    ASSERT_GE(Rational(interval.high), t) << show::text(hard_case);
    ++intervals;
  }
  if (hard::enough_cases(100000)) {
    EXPECT_GT(yes, count / 100);
    EXPECT_GT(no, count / 10);
    EXPECT_GT(unsure, count / 10);
    EXPECT_GT(intervals, count / 10);
  }
}

// Two triangles through points of the ray that are the same or all but: whatever the intervals of t
// say, the order is the true one.
TEST(CertifyBounds, near_hits_are_put_in_their_true_order) {
  predicate::LadderCounts counts;
  std::uint64_t equal = 0, compared = 0;
  const std::uint64_t count = hard::case_count(20000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 62, i);
    const auto grid = [&rng] { return static_cast<double>(rng.between(-64, 64)); };
    const Vec3<double> at{grid(), grid(), grid()}, d{grid(), grid(), grid() + 0.5};
    const predicate::RayD ray{{at.x - 4 * d.x, at.y - 4 * d.y, at.z - 4 * d.z}, d};
    const auto through = [&](int away) {
      const double k = std::ldexp(away, -rng.between(20, 44));
      const Vec3<double> e{grid(), grid(), grid()}, f{grid(), grid(), grid()};
      const Vec3<double> x{at.x + k * d.x, at.y + k * d.y, at.z + k * d.z};
      return predicate::TriangleD{{x.x - e.x - f.x, x.y - e.y - f.y, x.z - e.z - f.z},
                                  {x.x + 2 * e.x, x.y + 2 * e.y, x.z + 2 * e.z},
                                  {x.x + 2 * f.x, x.y + 2 * f.y, x.z + 2 * f.z}};
    };
    const predicate::TriangleD one = through(rng.between(-1, 1)), other = through(0);
    predicate::DecidedHit first, second;
    if (!predicate::decide_hit(ray, one, first, counts)) continue;
    if (!predicate::decide_hit(ray, other, second, counts)) continue;
    const auto t_of = [&ray](const predicate::TriangleD& t) {
      const Exact a = exact(t.a), n = cross_of(less(exact(t.b), a), less(exact(t.c), a));
      return Rational(dot_of(n, less(a, exact(ray.origin))) / dot_of(n, exact(ray.direction)));
    };
    const Rational x = t_of(one), y = t_of(other);
    const auto truth = cmp(x, y) <=> 0;
    ASSERT_EQ(predicate::decide_order(ray, first, second, counts), truth) << i;
    ++compared;
    equal += x == y ? 1 : 0;
  }
  if (hard::enough_cases(20000)) {
    EXPECT_GT(compared, count / 2);
    EXPECT_GT(equal, count / 20);
    EXPECT_GT(counts.orders_certified, 0U);
    EXPECT_GT(counts.orders_settled, count / 20);
  }
}

TEST(CertifyBounds, nothing_is_claimed_outside_the_window_of_magnitudes) {
  const predicate::TriangleD triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const predicate::RayD ray{{1, 1, 1}, {0, 0, -1}};
  ASSERT_EQ(certify_hit(filter_determinants(ray, triangle), ray), predicate::Certified::Yes);
  const auto claim_at = [&](int points, int direction) {
    const auto scaled = [](const Vec3<double>& p, int by) {
      return Vec3<double>{std::ldexp(p.x, by), std::ldexp(p.y, by), std::ldexp(p.z, by)};
    };
    const predicate::RayD moved{scaled(ray.origin, points), scaled(ray.direction, direction)};
    const predicate::TriangleD t{scaled(triangle.a, points), scaled(triangle.b, points),
                                 scaled(triangle.c, points)};
    return certify_hit(filter_determinants(moved, t), moved);
  };
  EXPECT_EQ(claim_at(140, -140), predicate::Certified::Yes);
  EXPECT_EQ(claim_at(-140, 140), predicate::Certified::Yes);
  for (const int by : {-1000, -400, -155, 155, 400, 1000}) {
    EXPECT_EQ(claim_at(by, 0), predicate::Certified::Unsure) << by;
    EXPECT_EQ(claim_at(0, by), predicate::Certified::Unsure) << by;
  }
}

}  // namespace
}  // namespace pierce
