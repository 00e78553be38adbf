// SPDX-License-Identifier: Apache-2.0
//
// Each textbook method in float, double and long double against the exact rational, on ordinary
// rays: triangles with corners anywhere in a cube, rays from outside it towards a point near the
// triangle. On these every decision is right; how far t, u and v are off is written down.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "pierce/textbook.h"
#include "support/rng.h"

namespace pierce {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::uint64_t kCases = 10000;

mpq_class rational(float x) { return {x}; }
mpq_class rational(double x) { return {x}; }
mpq_class rational(long double x) {  // its 64 bits fit two doubles
  const double head = static_cast<double>(x);
  return mpq_class(head) + mpq_class(static_cast<double>(x - static_cast<long double>(head)));
}

// |computed - exact| in units of the last place of a number in [low, 2 low).
template <class Real>
double error_in_units(Real computed, const mpq_class& exact, double low) {
  const mpq_class error = abs(mpq_class(rational(computed) - exact));
  return std::ldexp(error.get_d() / low, std::numeric_limits<Real>::digits - 1);
}

// The largest power of two that is not above x.
double power_of_two_below(const mpq_class& x) { return std::ldexp(1.0, std::ilogb(x.get_d())); }

struct Errors {
  double t = 0;   // in units of the last place of t
  double uv = 0;  // in units of the last place of 1: where u and v come from
};

// `Input` is the type that the numbers fit, `Real` the one that the method computes in.
template <class Input, class Real>
std::map<std::string_view, Errors> errors_on_ordinary_rays() {
  std::map<std::string_view, Errors> worst;
  std::uint64_t hits = 0;
  for (std::uint64_t i = 0; i < kCases; ++i) {
    hard::Rng rng(kSeed, i);
    const auto number = [&] { return static_cast<Input>(rng.symmetric()); };
    const auto point = [&] {
      const Input x = number(), y = number();
      return Vec3<Input>{x, y, number()};
    };
    const Vec3<Input> a = point(), b = point(), c = point();
    const Input along_ab = number(), along_ac = number();
    const Vec3<Input> target = a + along_ab * (b - a) + along_ac * (c - a);
    const Vec3<Input> origin = {2 * number(), 2 * number(), rng.coin() ? Input(2) : Input(-2)};
    const Ray<Input> ray = {origin, target - origin};

    const Ray<mpq_class> ray_q = convert<mpq_class>(ray);
    const Vec3<mpq_class> a_q = convert<mpq_class>(a), b_q = convert<mpq_class>(b),
                          c_q = convert<mpq_class>(c);
    const auto exact = textbook::cramer(ray_q, a_q, b_q, c_q);
    const bool front = dot(cross(b_q - a_q, c_q - a_q), ray_q.direction) < 0;
    if (exact) ++hits;

    const Ray<Real> ray_r = convert<Real>(ray);
    for (const textbook::Method<Real>& method : textbook::methods<Real>()) {
      const auto hit = method.test(ray_r, convert<Real>(a), convert<Real>(b), convert<Real>(c));
      const bool expected = exact && (front || !method.front_only);
      EXPECT_EQ(hit.has_value(), expected) << method.name << ", ray " << i;
      if (!hit || !expected) continue;
      Errors& errors = worst[method.name];
      errors.t = std::max(errors.t, error_in_units(hit->t, exact->t, power_of_two_below(exact->t)));
      errors.uv = std::max(
          {errors.uv, error_in_units(hit->u, exact->u, 1), error_in_units(hit->v, exact->v, 1)});
    }
  }
  EXPECT_GT(hits, kCases / 10);
  return worst;
}

// Largest errors as measured (2026-11, x86-64), rounded up. The arithmetic is IEEE 754 without
// fused operations and the rays are the same everywhere, so these are too.
using Bounds = std::map<std::string_view, Errors>;
const Bounds kFloat = {
    {"baldwin_weber", {2540, 5895}},
    {"cramer", {4081, 7461}},
    {"determinants", {1719, 7054}},
    {"moller_trumbore", {4081, 7552}},
    {"moller_trumbore, epsilon 0", {4081, 7552}},
    {"moller_trumbore_culling", {4081, 7552}},
    {"moller_trumbore_culling, epsilon 0", {4081, 7552}},
    {"plane_then_barycentric", {1719, 3990}},
    {"plane_then_edges", {1719, 3990}},
    {"precomputed_normal", {1719, 1870}},
    {"watertight", {1148, 2667}},
};
const Bounds kDouble = {
    {"baldwin_weber", {936, 2110}},
    {"cramer", {11500, 1571}},
    {"determinants", {3146, 4905}},
    {"moller_trumbore", {11410, 1571}},
    {"moller_trumbore, epsilon 0", {11410, 1571}},
    {"moller_trumbore_culling", {11410, 1571}},
    {"moller_trumbore_culling, epsilon 0", {11410, 1571}},
    {"plane_then_barycentric", {3146, 7304}},
    {"plane_then_edges", {3146, 7304}},
    {"precomputed_normal", {3146, 3813}},
    {"watertight", {406, 944}},
};
const Bounds kLongDouble = {
    {"baldwin_weber", {614, 1424}},
    {"cramer", {1384, 3493}},
    {"determinants", {145, 14369}},
    {"moller_trumbore", {1689, 3220}},
    {"moller_trumbore, epsilon 0", {1689, 3220}},
    {"moller_trumbore_culling", {1689, 3220}},
    {"moller_trumbore_culling, epsilon 0", {1689, 3220}},
    {"plane_then_barycentric", {145, 329}},
    {"plane_then_edges", {145, 334}},
    {"precomputed_normal", {145, 3880}},
    {"watertight", {2256, 5241}},
};

void expect_within(const Bounds& bounds, const std::map<std::string_view, Errors>& worst) {
  EXPECT_EQ(bounds.size(), worst.size());
  for (const auto& [method, measured] : worst) {
    ASSERT_TRUE(bounds.contains(method)) << method;
    EXPECT_LE(measured.t, bounds.at(method).t) << method << ": t";
    EXPECT_LE(measured.uv, bounds.at(method).uv) << method << ": u or v";
  }
}

TEST(TextbookOrdinary, in_float_every_decision_is_right_and_errors_are_as_once_measured) {
  expect_within(kFloat, errors_on_ordinary_rays<float, float>());
}

TEST(TextbookOrdinary, in_double_every_decision_is_right_and_errors_are_as_once_measured) {
  expect_within(kDouble, errors_on_ordinary_rays<double, double>());
}

TEST(TextbookOrdinary, in_long_double_every_decision_is_right_and_errors_are_as_once_measured) {
  if constexpr (std::numeric_limits<long double>::digits != 64) {
    GTEST_SKIP() << "measured for the 64-bit significand of x86";
  }
  expect_within(kLongDouble, errors_on_ordinary_rays<double, long double>());
}

}  // namespace
}  // namespace pierce
