// SPDX-License-Identifier: Apache-2.0
//
// The rounding without exact arithmetic, attacked: what round_certified claims is what the exact
// rung computes, to the bit, at hard places and next to the borders between two numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <type_traits>

#include "kernels/kernel.h"
#include "predicate/bounds.h"
#include "predicate/fine.h"
#include "predicate/round.h"
#include "predicate/round_between.h"
#include "predicate/settle.h"
#include "space/filter_ray.h"
#include "support/hard_cases.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Rng;

template <class Real>
class RoundBounds : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(RoundBounds, Reals);

// The pair in every column of a step, and what a kernel makes of it in the last one.
template <class Real>
bool round_in_lanes(const kernels::Kernel& kernel, const predicate::RayD& ray,
                    const predicate::TriangleD& triangle, Hit<Real>& hit) {
  static kernels::HitColumns columns;
  const Vec3<double> points[5] = {triangle.a, triangle.b, triangle.c, ray.origin, ray.direction};
  for (std::size_t row = 0; row < 15; ++row) {
    const Vec3<double>& p = points[row / 3];
    const double number = row % 3 == 0 ? p.x : row % 3 == 1 ? p.y : p.z;
    std::fill_n(columns.number[row], kernels::kRoundStep, number);
  }
  kernels::RoundedColumns<Real> out;
  kernel.of<Real>().round(columns, kernels::kRoundStep, out);
  constexpr std::size_t kLast = kernels::kRoundStep - 1;
  if (((out.sure >> kLast) & 1U) == 0) return false;
  hit.t = out.t[kLast];
  hit.u = out.u[kLast];
  hit.v = out.v[kLast];
  hit.w = out.w[kLast];
  hit.facing = ((out.front >> kLast) & 1U) != 0 ? Facing::Front : Facing::Back;
  return true;
}

// The same in lanes, many and one; counts what is claimed.
template <class Real>
void check_lanes(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                 std::uint64_t& claimed) {
  std::optional<Hit<Real>> expected;
  const auto claims = [&](bool claim, const Hit<Real>& found, const char* kernel) {
    if (!claim) return;
    ++claimed;
    if (!expected) expected = predicate::settle_numbers<Real>(ray, triangle);
    EXPECT_TRUE(show::same_bits(found, *expected))
        << kernel << ": " << show::text(found) << "\nfor " << show::text(*expected);
  };
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    Hit<Real> found;
    claims(round_in_lanes<Real>(*kernel, ray, triangle, found), found, kernel->name);
    found = {};
    Hit<Real> high;
    const auto rounded = kernel->of<Real>().round_one(ray, triangle, 0, found, high);
    claims(rounded == kernels::Rounded::All, found, kernel->name);
    if (rounded == kernels::Rounded::Ends) {
      predicate::LadderCounts counts;
      predicate::round_bounded_hit(ray, triangle, 0, high, found, counts);
      claims(true, found, kernel->name);
    }
    if constexpr (std::is_same_v<Real, float>) {
      found = {};
      claims(kernel->round_finely(ray, triangle, 0, found), found, kernel->name);
    } else {
      const Ray<double> in_place{ray.origin, ray.direction};
      found = {};
      claims(kernel->round_in_place(in_place, triangle.a, triangle.b, triangle.c, found), found,
             kernel->name);
      if (!space::is_float(triangle.a) || !space::is_float(triangle.b) ||
          !space::is_float(triangle.c))
        continue;
      float copy[9];  // at another scale, where that rounds nothing
      std::size_t k = 0;
      bool same = true;
      for (const Vec3<double>* p : {&triangle.a, &triangle.b, &triangle.c}) {
        for (const double x : {p->x, p->y, p->z}) {
          copy[k] = static_cast<float>(x * 0x1p-9);
          same &= static_cast<double>(copy[k++]) * 0x1p9 == x;
        }
      }
      found = {};
      claims(same && kernel->round_unscaled(in_place, {0, 1, copy}, 0x1p9, found), found,
             kernel->name);
    }
  }
}

// From the copy in a leaf: as if filter space were where the case is.
void check_copy(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                std::uint64_t& claimed) {
  float copy[9];
  space::FilterRay placed{};
  std::size_t k = 0;
  for (const Vec3<double>* p :
       {&triangle.a, &triangle.b, &triangle.c, &ray.origin, &ray.direction}) {
    if (!space::is_float(*p)) return;
    for (const double x : {p->x, p->y, p->z}) {
      if (std::fabs(x) > 4) return;
      float& number = k < 9 ? copy[k] : k < 12 ? placed.origin[k - 9] : placed.direction[k - 12];
      number = static_cast<float>(x);
      ++k;
    }
  }
  placed.exact = true;
  for (const double scale : {1.0, 0x1p-90, 0x1p70}) {
    predicate::RayD scaled = ray;
    scaled.direction = {ray.direction.x * scale, ray.direction.y * scale, ray.direction.z * scale};
    placed.tau_scale = scale;
    const auto expected = predicate::settle_numbers<float>(scaled, triangle);
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      Hit<float> found;
      if (!kernel->round_copy(placed, {0, 1, copy}, found)) continue;
      ++claimed;
      EXPECT_TRUE(show::same_bits(found, expected))
          << kernel->name << ": " << show::text(found) << "\nfor " << show::text(expected);
    }
  }
}

std::uint64_t claimed_in_lanes = 0, claimed_from_copies = 0, rounded_exactly = 0;

// All four numbers, by whatever rung has them.
template <class Real>
void check_whole(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                 std::uint8_t zeros, std::uint64_t& exactly) {
  predicate::LadderCounts counts;
  const auto found = predicate::round_hit<Real>(ray, triangle, zeros, counts);
  exactly += counts.rounded_exactly;
  const auto expected = predicate::settle_numbers<Real>(ray, triangle);
  EXPECT_TRUE(show::same_bits(found, expected))
      << show::text(found) << "\nfor " << show::text(expected);
}

// Compares with the exact rung; returns whether all of it was claimed.
template <class Real>
bool check(const predicate::RayD& ray, const predicate::TriangleD& triangle) {
  const predicate::Settled settled = predicate::settle_hit(ray, triangle);
  if (!settled.hit) return false;
  check_lanes<Real>(ray, triangle, claimed_in_lanes);
  check_whole<Real>(ray, triangle, settled.zeros, rounded_exactly);
  if constexpr (std::is_same_v<Real, float>) check_copy(ray, triangle, claimed_from_copies);
  Hit<Real> found;
  const predicate::Filtered f = predicate::filter_determinants(ray, triangle);
  const std::uint8_t sure = predicate::round_certified(ray, triangle, f, settled.zeros, found);
  if (sure == 0) return false;
  const Hit<Real> expected = predicate::settle_numbers<Real>(ray, triangle);
  if ((sure & predicate::kNumberT) == 0) found.t = expected.t;
  if ((sure & predicate::kNumberU) == 0) found.u = expected.u;
  if ((sure & predicate::kNumberV) == 0) found.v = expected.v;
  if ((sure & predicate::kNumberW) == 0) found.w = expected.w;
  EXPECT_TRUE(show::same_bits(found, expected))
      << show::text(found) << "\nfor " << show::text(expected) << "\n"
      << show::text(ray.origin) << show::text(ray.direction) << show::text(triangle.a)
      << show::text(triangle.b) << show::text(triangle.c);
  return sure == predicate::kAllNumbers;
}

TYPED_TEST(RoundBounds, what_is_claimed_of_hard_cases_is_the_correctly_rounded_number) {
  std::uint64_t claimed = 0;
  const std::uint64_t count = hard::case_count(60000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 92, i);
    auto c = hard::hard_case<TypeParam>(rng);
    c.ray.t_min = -kInfinity<TypeParam>;
    c.ray.t_max = kInfinity<TypeParam>;
    const predicate::TriangleD triangle{predicate::to_double(c.a), predicate::to_double(c.b),
                                        predicate::to_double(c.c)};
    claimed += check<TypeParam>(predicate::to_double(c.ray, Range::Closed), triangle) ? 1 : 0;
    if (this->HasFailure()) return;
  }
  if (!hard::enough_cases(60000)) return;
  EXPECT_GT(claimed, count / 20);
  const std::uint64_t wide = kernels::kernels().size() - 1;
  if (wide > 0) {
    EXPECT_GT(claimed_in_lanes, wide * count / 40);
    if constexpr (std::is_same_v<TypeParam, float>) {
      EXPECT_GT(claimed_from_copies, wide * count / 40);
    }
  }
}

// A plane z = height seen straight up from z = -off has t = height + off: with a height of all bits
// and an `off` of all but half a unit, t lies next to a tie, or on it.
TYPED_TEST(RoundBounds, what_is_claimed_next_to_a_tie_is_the_correctly_rounded_number) {
  constexpr int kDigits = std::numeric_limits<TypeParam>::digits;
  std::uint64_t claimed = 0, left = 0;
  const std::uint64_t count = hard::case_count(60000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 93, i);
    const double height = std::ldexp(std::floor(std::ldexp(1 + rng.unit(), kDigits - 1)), -kDigits);
    const double beside = rng.one_in(8) ? 0 : std::ldexp(rng.symmetric(), -rng.between(1, 60));
    const double off = std::ldexp(0.5 + beside, -kDigits);
    // u and v of all bits, too.
    const predicate::RayD ray{{0.25 * rng.unit(), 0.25 * rng.unit(), -off},
                              {0, 0, rng.coin() ? 1.0 : 0x1p-20},
                              -kInfinity<double>,
                              kInfinity<double>};
    const double far = 1 + rng.unit();
    const predicate::TriangleD triangle{{0, 0, height}, {far, 0, height}, {0, far, height}};
    ++(check<TypeParam>(ray, triangle) ? claimed : left);
    if (this->HasFailure()) return;
  }
  if (hard::enough_cases(60000)) {
    EXPECT_GT(claimed, count / 4);
    EXPECT_GT(left, count / 16);  // some are too near to tell
  }
}

// Of rays that all but lie in the plane double has few bits to spare; double-doubles have.
TEST(RoundBoundsFloat, numbers_of_grazing_rays_are_rounded_without_integers) {
  rounded_exactly = 0;
  std::uint64_t unsure = 0;
  const std::uint64_t count = hard::case_count(5000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 94, i);
    const auto number = [&] { return static_cast<double>(static_cast<float>(rng.symmetric())); };
    const double slope = static_cast<double>(static_cast<float>(std::ldexp(rng.unit() - 1.5, -20)));
    const predicate::RayD ray{{0.1 * number(), 0.1 * number(), -8 * slope},
                              {0.1 * number(), 0.1 * number(), slope},
                              -kInfinity<double>,
                              kInfinity<double>};
    const predicate::TriangleD triangle{{-4 + number(), -4, number() * 0x1p-30},
                                        {4, -4 + number(), number() * 0x1p-30},
                                        {number(), 4, number() * 0x1p-30}};
    Hit<float> found;
    const predicate::Filtered f = predicate::filter_determinants(ray, triangle);
    if (!predicate::settle_hit(ray, triangle).hit) continue;
    if (predicate::round_certified(ray, triangle, f, 0, found) != predicate::kAllNumbers) ++unsure;
    check<float>(ray, triangle);
    if (HasFailure()) return;
  }
  if (!hard::enough_cases(5000)) return;
  EXPECT_GT(unsure, count / 10);
  EXPECT_LT(rounded_exactly, unsure / 100);
}

// Numbers of few bits, as on grids; weights that are 0, or lie in the middle between two floats, or
// next to it by less than double can add; floors whose distance does.
TEST(RoundBoundsFloat, quotients_of_short_numbers_are_rounded_in_lanes) {
  std::uint64_t hits = 0, unsure = 0;
  claimed_in_lanes = 0;
  const std::uint64_t count = hard::case_count(60000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 97, i);
    const auto integer = [&](int bits) { return std::floor(std::ldexp(rng.symmetric(), bits)); };
    const double size = std::ldexp(1, rng.between(0, 8)), far = size * rng.between(1, 7);
    predicate::TriangleD triangle{{0, 0, integer(6)}, {size, 0, integer(6)}, {0, far, integer(6)}};
    if (rng.coin()) {  // a floor
      const double height = 1 + std::ldexp(integer(24), -24);
      triangle.a.z = triangle.b.z = triangle.c.z = height;
    }
    // Up to 26 bits of the square's side.
    const auto place = [&](double side) {
      return rng.one_in(6) ? 0 : side * std::ldexp(std::fabs(integer(26)), -26) / 2;
    };
    predicate::RayD ray{{place(size), place(far), -integer(12)}, {0, 0, 1}, -kInfinity<double>};
    if (rng.one_in(3)) {
      ray.direction = {integer(4), integer(4), 1 + std::fabs(integer(4))};
      ray.origin = {0.25 * size + integer(3), 0.25 * far + integer(3), -integer(3)};
    }
    if (rng.one_in(4)) {  // what is added to a weight is no double, and may underflow
      triangle.a.z = triangle.b.z = triangle.c.z = 0;
      ray.direction.x = std::ldexp(rng.coin() ? 1 : -1,
                                   -(rng.coin() ? rng.between(60, 200) : rng.between(800, 1000)));
      ray.origin.z = -std::ldexp(1, -rng.between(0, 140));
    }
    if (!predicate::settle_hit(ray, triangle).hit) continue;
    ++hits;
    Hit<float> found;
    const predicate::Filtered f = predicate::filter_determinants(ray, triangle);
    unsure +=
        predicate::round_certified(ray, triangle, f, 0, found) == predicate::kAllNumbers ? 0 : 1;
    check<float>(ray, triangle);
    if (HasFailure()) return;
  }
  if (!hard::enough_cases(60000)) return;
  EXPECT_GT(unsure, hits / 4);
  const std::uint64_t wide = kernels::kernels().size() - 1;
  EXPECT_GT(claimed_in_lanes, wide * 3 * hits * 3 / 4);
}

// Of the neighbours `p` and `q`, for all four numbers, what round_between takes is the expected
// one. Returns how many it decides.
template <class Real>
int check_between(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                  const Hit<Real>& expected, const Hit<Real>& p, const Hit<Real>& q) {
  Hit<Real> found = p;
  const std::uint8_t done =
      predicate::round_between(ray, triangle, predicate::kAllNumbers, q, found);
  const auto left = [done](std::uint8_t number) { return (done & number) == 0; };
  if (left(predicate::kNumberT)) found.t = expected.t;
  if (left(predicate::kNumberU)) found.u = expected.u;
  if (left(predicate::kNumberV)) found.v = expected.v;
  if (left(predicate::kNumberW)) found.w = expected.w;
  EXPECT_TRUE(show::same_bits(found, expected))
      << show::text(found) << "\nfor " << show::text(expected) << "\n"
      << show::text(ray.origin) << show::text(ray.direction) << show::text(triangle.a)
      << show::text(triangle.b) << show::text(triangle.c);
  return std::popcount(done);
}

// Integers of 2 to 59 bits, each kind of vector of its own length; some directions along an axis,
// and some triangles whose weights are ties: their corners are powers of two apart.
TYPED_TEST(RoundBounds, of_two_neighbours_the_nearer_one_is_taken) {
  using Real = TypeParam;
  std::uint64_t decided = 0;
  const std::uint64_t count = hard::case_count(60000);
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed() + 94, i);
    const auto integers = [&](int bits) {
      const auto one = [&] { return std::floor(std::ldexp(rng.symmetric(), bits)); };
      return Vec3<double>{one(), one(), one()};
    };
    const int bits = rng.between(2, rng.coin() ? 24 : 59);
    predicate::RayD ray{integers(bits), integers(rng.between(1, 53)), -kInfinity<double>,
                        kInfinity<double>};
    predicate::TriangleD triangle{integers(bits), integers(bits), integers(bits)};
    if (rng.coin()) ray.direction = {0, 0, 1};
    if (rng.coin()) {
      const double size = std::ldexp(1, rng.between(0, bits));
      triangle = {{0, 0, triangle.a.z}, {size, 0, triangle.b.z}, {0, 2 * size, triangle.c.z}};
    }
    if (rng.one_in(3)) ray.direction = integers(rng.between(1, 53));
    if (rng.one_in(3)) {  // across an axis
      double Vec3<double>::*const axis = rng.coin() ? &Vec3<double>::z : &Vec3<double>::x;
      triangle.b.*axis = triangle.c.*axis = triangle.a.*axis;
    }
    const auto den = predicate::fine_determinants(ray, triangle).den.high;
    if (std::fabs(den) <= predicate::filter_determinants(ray, triangle).den_err) continue;
    const Hit<Real> expected = predicate::settle_numbers<Real>(ray, triangle);
    Hit<Real> below = expected, above = expected;
    for (Real Hit<Real>::*number : {&Hit<Real>::t, &Hit<Real>::u, &Hit<Real>::v, &Hit<Real>::w}) {
      below.*number = std::nextafter(expected.*number, -kInfinity<Real>);
      above.*number = std::nextafter(expected.*number, kInfinity<Real>);
    }
    decided += static_cast<std::uint64_t>(check_between(ray, triangle, expected, below, expected));
    decided += static_cast<std::uint64_t>(check_between(ray, triangle, expected, expected, above));
    if (this->HasFailure()) return;
  }
  if (hard::enough_cases(60000)) {
    EXPECT_GT(decided, count);
  }
}

TEST(RoundBoundsFloat, a_number_that_rounds_to_zero_is_left_to_the_exact_rung) {
  // t = -2^-149 / 2^20 and so on: rounds to zero, whose sign has to be +.
  const predicate::RayD ray{{0.25, 0.25, -0x1p-149}, {0, 0, -0x1p20}, -1, 1};
  const predicate::TriangleD triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Hit<float> found;
  const predicate::Filtered f = predicate::filter_determinants(ray, triangle);
  ASSERT_TRUE(f.usable);
  EXPECT_EQ(predicate::round_certified(ray, triangle, f, 0, found) & predicate::kNumberT, 0);
  const Hit<float> exact = predicate::settle_numbers<float>(ray, triangle);
  EXPECT_TRUE(show::same_bits(exact.t, 0.0F));
}

}  // namespace
}  // namespace pierce
