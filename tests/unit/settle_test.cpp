// SPDX-License-Identifier: Apache-2.0
//
// The exact rung against numbers of any size, with integers of every width; and with what double is
// sure of against itself without.
#include "predicate/settle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "predicate/determinants.h"
#include "support/dyadic.h"
#include "support/near_pairs.h"
#include "support/rng.h"
#include "support/run_cases.h"

namespace pierce::predicate {
namespace {

using hard::nearly;
using hard::Rng;
using oracle::Dyadic;

Triple<Dyadic> exactly(const Vec3<double>& p) { return {Dyadic(p.x), Dyadic(p.y), Dyadic(p.z)}; }

struct Truth {
  bool hit;
  std::uint8_t zeros;
};

Truth true_answer(const RayD& ray, const TriangleD& t) {
  const auto a = exactly(t.a);
  const auto value = determinants_of(a - exactly(ray.origin), exactly(t.b) - a, exactly(t.c) - a,
                                     exactly(ray.direction));
  const int den = value.den.sign();
  const int u = den * value.u.sign(), v = den * value.v.sign(), w = den * value.w.sign();
  const auto above = [&](double bound) {  // the sign of t - bound
    if (std::isinf(bound)) return bound > 0 ? -1 : 1;
    return den * (value.t - Dyadic(bound) * value.den).sign();
  };
  const int start = above(ray.t_min);
  const bool in_range = (start > 0 || (start == 0 && !ray.open_start)) && above(ray.t_max) <= 0;
  return {den != 0 && u >= 0 && v >= 0 && w >= 0 && in_range,
          static_cast<std::uint8_t>((u == 0 ? kZeroU : 0) | (v == 0 ? kZeroV : 0) |
                                    (w == 0 ? kZeroW : 0))};
}

// As a part that was turned by 90 degrees, of whose zeros sine and cosine made 1e-17; or smaller.
void add_noise(Rng& rng, RayD& ray, TriangleD& t) {
  const int place = rng.between(20, 200);
  const auto noise = [&](double& x) {
    if (rng.coin()) x = std::ldexp(rng.one_in(3) ? 0.0 : rng.symmetric(), -place);
  };
  const int axis = rng.between(0, 2);
  for (Vec3<double>* p : {&t.a, &t.b, &t.c, &ray.origin, &ray.direction})
    noise(axis == 0 ? p->x : axis == 1 ? p->y : p->z);
}

TEST(Settle, every_width_settles_what_numbers_of_any_size_do) {
  std::array<int, 4> widths{};
  int hits = 0, zeros = 0;
  for (std::uint64_t i = 0; i < hard::case_count(60000); ++i) {
    Rng rng(hard::seed() + 13, i);
    auto [ray, t] = nearly(rng);
    if (rng.coin()) add_noise(rng, ray, t);
    const Truth truth = true_answer(ray, t);
    const auto check = [&](const Settled& found) {
      ASSERT_EQ(found.hit, truth.hit);
      if (truth.hit) {
        ASSERT_EQ(found.zeros, truth.zeros);
      }
    };
    const Settled plainly = settle_hit(ray, t);
    check(plainly);
    ++widths[static_cast<std::size_t>(plainly.width)];
    const Filtered f = filter_determinants(ray, t);
    if (certify_hit(f, ray) == Certified::Unsure) check(settle_hit(ray, t, f));
    if (HasFatalFailure()) return;
    hits += truth.hit ? 1 : 0;
    zeros += truth.hit && truth.zeros != 0 ? 1 : 0;
  }
  if (!hard::enough_cases(60000)) return;
  for (const int count : widths) EXPECT_GT(count, 500);
  EXPECT_GT(hits, 10000);
  EXPECT_GT(zeros, 1500);
}

TEST(Settle, what_double_is_sure_of_changes_nothing) {
  int hits = 0, all = 0;
  for (std::uint64_t i = 0; i < hard::case_count(60000); ++i) {
    Rng rng(hard::seed() + 12, i);
    auto [ray, t] = nearly(rng);
    if (rng.one_in(4)) add_noise(rng, ray, t);
    const Filtered f = filter_determinants(ray, t);
    if (certify_hit(f, ray) != Certified::Unsure) continue;
    const Settled truth = settle_hit(ray, t), found = settle_hit(ray, t, f);
    ++all;
    hits += truth.hit ? 1 : 0;
    ASSERT_EQ(found.hit, truth.hit);
    if (!truth.hit) continue;
    EXPECT_EQ(found.facing, truth.facing);
    EXPECT_EQ(found.zeros, truth.zeros);
  }
  if (!hard::enough_cases(60000)) return;
  EXPECT_GT(all, 20000);
  EXPECT_GT(hits, all / 10);
  EXPECT_LT(hits, all * 9 / 10);
}

}  // namespace
}  // namespace pierce::predicate
