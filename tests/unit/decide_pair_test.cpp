// SPDX-License-Identifier: Apache-2.0
//
// What kernels say of a pair in double, and in compensated double, against the exact rung: whatever
// is sure is right, and of what double does not know most is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "kernels/kernel.h"
#include "predicate/certify.h"
#include "predicate/settle.h"
#include "support/dyadic.h"
#include "support/near_pairs.h"
#include "support/rng.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::Rng;
using oracle::Dyadic;
using predicate::Certified;

// Whether T / den lies within.
bool holds(const predicate::Interval& t, const predicate::RayD& ray,
           const predicate::TriangleD& triangle) {
  if (std::isinf(t.low) && std::isinf(t.high)) return t.low < t.high;  // nothing is known
  const auto exactly = [](const Vec3<double>& p) {
    return predicate::Triple<Dyadic>{Dyadic(p.x), Dyadic(p.y), Dyadic(p.z)};
  };
  const auto a = exactly(triangle.a);
  const auto value = predicate::determinants_of(a - exactly(ray.origin), exactly(triangle.b) - a,
                                                exactly(triangle.c) - a, exactly(ray.direction));
  const auto side = [&](double bound) {
    return value.den.sign() * compare(value.t, Dyadic(bound) * value.den);
  };
  return side(t.low) >= 0 && side(t.high) <= 0;
}

TEST(DecidePair, what_is_sure_is_right) {
  std::uint64_t unsure = 0, decided = 0, yes = 0;
  const std::uint64_t count = hard::case_count(60000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 21, i);
    auto [ray, triangle] = hard::nearly(rng);
    if (rng.one_in(3)) ray.t_max = 1;  // where those end that are aimed
    const auto filtered = predicate::filter_determinants(ray, triangle);
    const double place = filtered.value.t / filtered.value.den;  // or where it is hit
    if (rng.one_in(3) && place > 0 && std::isfinite(place)) ray.t_max = place;
    const bool truth = predicate::settle_hit(ray, triangle).hit;
    const bool open = predicate::certify_hit(filtered, ray) == Certified::Unsure;
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      predicate::Interval t;
      const Certified answer = kernel->decide_pair(ray, triangle, t);
      if (open) ++unsure;
      if (answer == Certified::Unsure) continue;
      if (open) ++decided;
      ASSERT_EQ(answer == Certified::Yes, truth) << kernel->name;
      if (!truth) continue;
      ++yes;
      EXPECT_TRUE(holds(t, ray, triangle)) << kernel->name;
    }
  }
  const std::uint64_t kernels_with_lanes = kernels::kernels().size() - 1;
  if (!hard::enough_cases(60000) || kernels_with_lanes < 2) return;
  EXPECT_GT(yes, count / 4);
  EXPECT_GT(decided, unsure / 8);
}

}  // namespace
}  // namespace pierce
