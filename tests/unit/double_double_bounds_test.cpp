// SPDX-License-Identifier: Apache-2.0
//
// Double-doubles, attacked: each operation, and the determinants made of them, against rational
// arithmetic.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "predicate/fine.h"
#include "support/rng.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using exact::DoubleDouble;
using hard::Rng;
using Rational = mpq_class;

constexpr double kUnit = 0x1p-106;

Rational rational(const DoubleDouble& x) { return Rational(x.high) + Rational(x.low); }

DoubleDouble draw(Rng& rng, int reach) {
  const double high = std::ldexp(rng.symmetric(), rng.between(-reach, reach));
  return exact::two_sum(high, high * rng.symmetric() * 0x1p-53);
}

TEST(DoubleDoubleBounds, every_operation_is_within_eight_units) {
  double worst_product = 0, worst_sum = 0, worst_quotient = 0;
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 90, i);
    const DoubleDouble a = draw(rng, 100);
    DoubleDouble b = draw(rng, 100);
    if (rng.one_in(4)) {  // sums that all but cancel
      b = exact::two_sum(-a.high * (1 + std::ldexp(rng.symmetric(), -rng.between(1, 60))),
                         std::ldexp(a.high * rng.symmetric(), -rng.between(53, 60)));
    }
    if (a.high == 0 || b.high == 0) continue;
    const Rational x = rational(a), y = rational(b);
    const auto off = [](const DoubleDouble& found, const Rational& truth, const Rational& size) {
      const Rational ratio = abs(rational(found) - truth) / size / Rational(kUnit);
      return ratio.get_d();
    };
    worst_product = std::max(worst_product, off(a * b, x * y, abs(x * y)));
    worst_product = std::max(worst_product, off(a * b.high, x * Rational(b.high), abs(x * y)));
    worst_sum = std::max(worst_sum, off(a + b, x + y, abs(x) + abs(y)));
    worst_sum = std::max(worst_sum, off(a - b, x - y, abs(x) + abs(y)));
    worst_quotient = std::max(worst_quotient, off(a / b, x / y, abs(x / y)));
  }
  EXPECT_LE(worst_product, 8);
  EXPECT_LE(worst_sum, 8);
  EXPECT_LE(worst_quotient, 32);
  if (hard::enough_cases(20000)) {
    EXPECT_GT(worst_product, 2);  // the bounds are not out of all proportion
    EXPECT_GT(worst_sum, 1);
  }
}

template <class T>
predicate::Triple<T> triple_of(const Vec3<double>& p, const Vec3<double>& q) {
  if constexpr (std::is_same_v<T, DoubleDouble>) {
    return {exact::two_sum(p.x, -q.x), exact::two_sum(p.y, -q.y), exact::two_sum(p.z, -q.z)};
  } else {
    return {T(Rational(p.x) - Rational(q.x)), T(Rational(p.y) - Rational(q.y)),
            T(Rational(p.z) - Rational(q.z))};
  }
}

Rational dot_of(const predicate::Triple<Rational>& p, const predicate::Triple<Rational>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}
predicate::Triple<Rational> cross_of(const predicate::Triple<Rational>& p,
                                     const predicate::Triple<Rational>& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

TEST(DoubleDoubleBounds, the_determinants_are_within_their_bound) {
  constexpr double kCounted = 224 * 0x1p-106;  // docs/algorithm.md, "Rounding"
  static_assert(kCounted < bounds::kDoubleDoubleFactor);
  double worst = 0;
  for (std::uint64_t i = 0; i < hard::case_count(5000); ++i) {
    Rng rng(hard::seed() + 91, i);
    const auto point = [&] {
      return Vec3<double>{rng.symmetric(), rng.symmetric(), rng.symmetric()};
    };
    const Vec3<double> o = point(), d = point(), a = point(), b = point(), c = point();
    const auto found = predicate::determinants_of(
        triple_of<DoubleDouble>(a, o), triple_of<DoubleDouble>(b, a), triple_of<DoubleDouble>(c, a),
        predicate::Triple<double>{d.x, d.y, d.z});
    const auto s = triple_of<Rational>(a, o), e1 = triple_of<Rational>(b, a),
               e2 = triple_of<Rational>(c, a), direction = triple_of<Rational>(d, {0, 0, 0});
    const auto largest = [](const predicate::Triple<Rational>& p) {
      const Rational x = abs(p.x), y = abs(p.y), z = abs(p.z);
      return std::max({x.get_d(), y.get_d(), z.get_d()});
    };
    const auto off = [&](const DoubleDouble& value, const Rational& truth, double size) {
      const Rational ratio = abs(rational(value) - truth) / Rational(size * kCounted);
      worst = std::max(worst, ratio.get_d());
    };
    const auto n = cross_of(e1, e2), r = cross_of(direction, s);
    off(found.den, dot_of(n, direction), largest(e1) * largest(e2) * largest(direction));
    off(found.v, dot_of(r, e1), largest(direction) * largest(s) * largest(e1));
    off(found.u, -dot_of(r, e2), largest(direction) * largest(s) * largest(e2));
    off(found.t, dot_of(n, s), largest(e1) * largest(e2) * largest(s));
  }
  EXPECT_LE(worst, 1);
  if (hard::enough_cases(5000)) {
    EXPECT_GT(worst, 0.01);
  }
}

}  // namespace
}  // namespace pierce
