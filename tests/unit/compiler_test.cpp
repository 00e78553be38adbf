// SPDX-License-Identifier: Apache-2.0
//
// What the proofs take for granted of the compiler, tried: every rounding that is written happens,
// once, and nothing else does.
#include <gtest/gtest.h>

#include <array>
#include <cfenv>
#include <cmath>
#include <limits>

#include "pierce/types.h"

namespace pierce {
namespace {

// Values the compiler cannot see through.
template <class Real>
Real opaque(Real x) {
  volatile Real y = x;
  return y;
}

[[gnu::noinline]] Vec3<double> through_float(const Vec3<double>& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

[[gnu::noinline]] std::array<double, 8> through_float(const std::array<double, 8>& p) {
  std::array<double, 8> q;
  for (std::size_t i = 0; i < 8; ++i) q[i] = static_cast<float>(p[i]);
  return q;
}

// g++ 12 leaves the rounding out of the first two when it may vectorise straight-line code.
TEST(Compiler, a_double_that_passes_through_float_is_rounded) {
  const double third = opaque(1.0 / 3);
  const double rounded = opaque(static_cast<float>(third));
  EXPECT_NE(rounded, third);
  const Vec3<double> p = through_float(Vec3<double>{third, third, third});
  EXPECT_EQ(p.x, rounded);
  EXPECT_EQ(p.y, rounded);
  EXPECT_EQ(p.z, rounded);
  std::array<double, 8> many;
  many.fill(third);
  for (const double x : through_float(many)) EXPECT_EQ(x, rounded);
}

[[gnu::noinline]] float product_less(float a, float b, float c) { return a * b - c; }
[[gnu::noinline]] double product_less(double a, double b, double c) { return a * b - c; }

TEST(Compiler, a_product_is_rounded_before_it_is_added_to) {
  const float a = 1 + std::numeric_limits<float>::epsilon();
  EXPECT_EQ(product_less(a, a, opaque(a * a)), 0.0F);
  const double b = 1 + std::numeric_limits<double>::epsilon();
  EXPECT_EQ(product_less(b, b, opaque(b * b)), 0.0);
}

TEST(Compiler, float_arithmetic_is_not_done_in_double) {
  const float tiny = opaque(0x1p-24F);
  EXPECT_EQ(opaque(1.0F) + tiny + tiny, 1.0F);
}

TEST(Compiler, subnormal_numbers_are_kept_and_rounding_is_to_nearest) {
  EXPECT_EQ(std::fegetround(), FE_TONEAREST);
  EXPECT_GT(opaque(std::numeric_limits<float>::min()) / 2, 0.0F);
  EXPECT_GT(opaque(std::numeric_limits<double>::min()) / 2, 0.0);
  EXPECT_EQ(opaque(0.0) * -1, 0.0);
  EXPECT_TRUE(std::signbit(opaque(0.0) * -1));
}

}  // namespace
}  // namespace pierce
