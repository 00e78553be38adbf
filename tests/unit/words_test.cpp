// SPDX-License-Identifier: Apache-2.0
//
// Signs of small determinants modulo 2^128, against numbers of any size; and what the exact rung
// makes of them and of what double is sure of, against itself without either.
#include "predicate/words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "predicate/settle.h"
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

TEST(Words, what_is_known_of_small_determinants_is_right) {
  int known = 0, unsure = 0, zero = 0;
  for (std::uint64_t i = 0; i < hard::case_count(60000); ++i) {
    Rng rng(hard::seed() + 11, i);
    const auto [ray, t] = nearly(rng);
    const Filtered f = filter_determinants(ray, t);
    if (!f.usable) continue;
    const SmallSigns signs(ray, t, f);
    const auto a = exactly(t.a);
    const auto truth = determinants_of(a - exactly(ray.origin), exactly(t.b) - a, exactly(t.c) - a,
                                       exactly(ray.direction));
    const auto check = [&](std::optional<int> sign, const Dyadic& number, double rough,
                           double err) {
      const bool open = std::fabs(rough) <= err;
      unsure += open ? 1 : 0;
      if (!sign) return;
      known += open ? 1 : 0;
      zero += *sign == 0 ? 1 : 0;
      EXPECT_EQ(*sign, number.sign());
    };
    check(signs.den, truth.den, f.value.den, f.den_err);
    check(signs.u, truth.u, f.value.u, f.uv_err);
    check(signs.v, truth.v, f.value.v, f.uv_err);
    check(signs.w, truth.w, f.value.w, f.w_err);
    check(signs.t, truth.t, f.value.t, f.t_err);
    if (HasFailure()) return;
  }
  if (!hard::enough_cases(60000)) return;
  EXPECT_GT(unsure, 20000);
  EXPECT_GT(zero, 2000);
  EXPECT_GT(known, unsure * 8 / 10);
}

TEST(Words, what_is_settled_with_their_help_is_what_integers_settle) {
  int hits = 0, all = 0;
  for (std::uint64_t i = 0; i < hard::case_count(60000); ++i) {
    Rng rng(hard::seed() + 12, i);
    const auto [ray, t] = nearly(rng);
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

// The largest numbers that fit, so that nothing but what double says keeps determinants small.
TEST(Words, what_is_not_small_is_not_known) {
  const double most = 0x1p53 - 1;
  const TriangleD t{{-most, -most, 0}, {most, -most, 0}, {0, most, 0}};
  const RayD ray{{0.0078125, 0, -most}, {0, 0, most}};
  const SmallSigns signs(ray, t, filter_determinants(ray, t));
  EXPECT_FALSE(signs.den);
  EXPECT_FALSE(signs.t);
}

}  // namespace
}  // namespace pierce::predicate
