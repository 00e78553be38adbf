// SPDX-License-Identifier: Apache-2.0
//
// Rounding outward: the one thing in the builder on which answers rest.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bvh/box.h"
#include "support/bvh_sources.h"

namespace pierce::bvh {
namespace {

/// Whether f is the largest float not above x, by trying the next one.
bool is_tight_below(float f, double x) {
  const float next = std::nextafter(f, std::numeric_limits<float>::infinity());
  return static_cast<double>(f) <= x && static_cast<double>(next) > x;
}

void expect_tight(double x) {
  EXPECT_PRED2(is_tight_below, round_down(x), x);
  EXPECT_PRED2(is_tight_below, -round_up(x), -x);
}

TEST(BvhBox, rounding_down_gives_the_largest_float_not_above) {
  for (std::uint64_t k = 0; k < 200000; ++k) {
    expect_tight(random_at(k));
    expect_tight(std::ldexp(random_at(k), -static_cast<int>(k % 200)));
  }
}

TEST(BvhBox, rounding_is_exact_at_floats_and_tight_beside_them) {
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const auto f = static_cast<float>(std::ldexp(random_at(k), -static_cast<int>(k % 160)));
    const auto x = static_cast<double>(f);
    EXPECT_EQ(round_down(x), f);
    EXPECT_EQ(round_up(x), f);
    expect_tight(std::nextafter(x, 2.0));
    expect_tight(std::nextafter(x, -2.0));
  }
}

TEST(BvhBox, rounding_is_tight_at_zero_denormals_and_powers_of_two) {
  for (const double sign : {1.0, -1.0}) {
    for (int e = 0; e > -1100; --e) {
      const double x = std::ldexp(sign, e);
      expect_tight(x);
      expect_tight(std::nextafter(x, 2.0));
      expect_tight(std::nextafter(x, -2.0));
      expect_tight(x * 1.5);
    }
    expect_tight(sign * 0.0);
    expect_tight(sign * std::numeric_limits<double>::denorm_min());
  }
}

TEST(BvhBox, a_box_holds_its_triangle_and_touches_it) {
  for (std::uint64_t k = 0; k < 20000; ++k) {
    const Corners t{random_point(3 * k, 1.0), random_point(3 * k + 1, 1.0),
                    random_point(3 * k + 2, 1e-3)};
    const Box box = box_of(t);
    const double x[3] = {t.a.x, t.b.x, t.c.x}, y[3] = {t.a.y, t.b.y, t.c.y},
                 z[3] = {t.a.z, t.b.z, t.c.z};
    int axis = 0;
    for (const double* values : {x, y, z}) {
      EXPECT_EQ(box.lower[axis], round_down(std::min({values[0], values[1], values[2]})));
      EXPECT_EQ(box.upper[axis], round_up(std::max({values[0], values[1], values[2]})));
      ++axis;
    }
  }
}

}  // namespace
}  // namespace pierce::bvh
