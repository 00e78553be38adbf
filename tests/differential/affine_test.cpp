// SPDX-License-Identifier: Apache-2.0
//
// One coordinate of an affine map against integers of GMP: ordinary numbers, numbers that cancel,
// ties and a hair beside them, subnormal results, the borders of overflow. Both rungs are met.
#include "exact/affine.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/hard_numbers.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce::exact {
namespace {

using hard::Rng;
using hard::Style;
using oracle::Dyadic;

template <class Real>
struct Map {
  std::array<Real, 4> m;
  Vec3<Real> p;

  [[nodiscard]] Dyadic value() const {
    return Dyadic(m[0]) * Dyadic(p.x) + Dyadic(m[1]) * Dyadic(p.y) + Dyadic(m[2]) * Dyadic(p.z) +
           Dyadic(m[3]);
  }
};

template <class Real>
class Affine : public testing::Test {
 public:
  static void expect_rounded(const Map<Real>& map) {
    const auto& m = map.m;
    const auto& p = map.p;
    const Real expected = oracle::round_dyadic<Real>(map.value());
    const auto text = [&] {
      return show::joined('{', show::text(m[0]), ", ", show::text(m[1]), ", ", show::text(m[2]),
                          ", ", show::text(m[3]), "} ", show::text(p));
    };
    ASSERT_TRUE(show::same_bits(round_affine(m, p.x, p.y, p.z), expected)) << text();
    ASSERT_TRUE(show::same_bits(round_affine_exactly(m, p.x, p.y, p.z), expected)) << text();
    ++asked;
    unsure += certify_affine(m, p.x, p.y, p.z) ? 0 : 1;
    ties += oracle::is_tie<Real>(map.value(), Dyadic(1)) ? 1 : 0;
  }

  void SetUp() override { asked = unsure = ties = 0; }

  static Map<Real> draw(Rng& rng, Style rows, Style points) {
    Map<Real> map;
    for (Real& x : map.m) x = hard::number<Real>(rng, rows);
    map.p = hard::vec<Real>(rng, points);
    return map;
  }

  inline static std::uint64_t asked = 0, unsure = 0, ties = 0;
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Affine, Reals);

TYPED_TEST(Affine, of_any_numbers_is_rounded_once) {
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 920, i);
    this->expect_rounded(this->draw(rng, rng.pick(hard::kAllStyles), rng.pick(hard::kAllStyles)));
    if (this->HasFatalFailure()) return;
  }
  if (hard::enough_cases(40000)) {
    EXPECT_GT(this->unsure, 100U);
  }
}

TYPED_TEST(Affine, of_ordinary_numbers_is_certain_in_double) {
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 921, i);
    this->expect_rounded(this->draw(rng, Style::Unit, Style::Unit));
    if (this->HasFatalFailure()) return;
  }
  EXPECT_LE(this->unsure, this->asked / 10000);
}

// The fourth number all but takes away what the first three add up to.
TYPED_TEST(Affine, of_numbers_that_cancel_is_rounded_once) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 922, i);
    auto map = this->draw(rng, rng.pick(hard::kTameStyles), rng.pick(hard::kTameStyles));
    map.m[3] = 0;
    if (rng.coin()) {  // two of the products cancel, too
      map.m[1] = map.m[0];
      map.p.y = hard::nudged(-map.p.x, rng.between(-1, 1));
    }
    map.m[3] = hard::nudged(-oracle::round_dyadic<Real>(map.value()), rng.between(-2, 2));
    this->expect_rounded(map);
    if (this->HasFatalFailure()) return;
  }
}

// 1 * x + m * y + t where x + t needs one bit too many and m * y is nothing, or next to nothing.
TYPED_TEST(Affine, at_a_tie_and_a_hair_beside_it_is_rounded_once) {
  using Real = TypeParam;
  using Limits = std::numeric_limits<Real>;
  for (std::uint64_t i = 0; i < hard::case_count(40000); ++i) {
    Rng rng(hard::seed() + 923, i);
    const auto odd = static_cast<Real>((rng.bits() >> (64 - Limits::digits)) | 1U);
    const Real half = rng.coin() ? Real(0.5) : Real(-0.5);
    Map<Real> map{{odd, 0, 0, half}, {1, 0, 0}};
    if (rng.coin()) {
      const int exponent = -rng.between(1, -Limits::min_exponent + Limits::digits);
      map.m[1] = std::ldexp(rng.coin() ? Real(1) : Real(-1), exponent);
      map.p.y = 1;
    }
    if (rng.coin()) {  // to where the last place is that of the subnormals, or anywhere
      const int low = Limits::min_exponent - Limits::digits;
      const int exponent = rng.coin() ? low : rng.between(low, 60);
      map.p.x = std::ldexp(Real(1), exponent / 2);
      map.m[0] = std::ldexp(odd, exponent - exponent / 2);
      map.m[3] = std::ldexp(half, exponent);
      map.p.y = std::ldexp(map.p.y, std::max(exponent, low / 2));
    }
    this->expect_rounded(map);
    if (this->HasFatalFailure()) return;
  }
  if (hard::enough_cases(40000)) {
    EXPECT_GT(this->ties, this->asked / 10);
  }
}

// Half a last place beyond the largest number is where overflow begins; and it may be undone.
TYPED_TEST(Affine, next_to_the_largest_number_overflows_only_where_it_must) {
  using Real = TypeParam;
  using Limits = std::numeric_limits<Real>;
  const Real most = Limits::max();
  const Real half = std::ldexp(Real(1), Limits::max_exponent - Limits::digits - 1);
  const Real less = std::nextafter(half, Real(0));
  this->expect_rounded({{1, 1, 0, 0}, {most, half, 0}});
  this->expect_rounded({{1, 1, 0, 0}, {most, less, 0}});
  this->expect_rounded({{1, 1, 1, 0}, {most, half, -Limits::denorm_min()}});
  this->expect_rounded({{1, 1, 1, -most}, {most, most, most}});
  this->expect_rounded({{1, 1, 1, -most}, {most, most, -most}});
  this->expect_rounded({{most, -most, 1, 0}, {most, most, 3}});
  this->expect_rounded({{most, -most, most, 7}, {most, most, Real(0.5)}});
  EXPECT_EQ(round_affine<Real>({1, 1, 0, 0}, most, half, 0), Limits::infinity());
  EXPECT_EQ(round_affine<Real>({1, 1, 0, 0}, most, less, 0), most);
  for (std::uint64_t i = 0; i < hard::case_count(20000); ++i) {
    Rng rng(hard::seed() + 924, i);
    auto map = this->draw(rng, Style::SmallInteger, Style::NearOverflow);
    map.m[3] = hard::number<Real>(rng, Style::NearOverflow);
    if (rng.coin()) std::swap(map.m[0], map.p.x);
    this->expect_rounded(map);
    if (this->HasFatalFailure()) return;
  }
}

TYPED_TEST(Affine, of_zeros_is_plus_zero) {
  using Real = TypeParam;
  const Real zero = -Real(0);
  EXPECT_FALSE(std::signbit(round_affine<Real>({zero, zero, zero, zero}, 1, 1, 1)));
  EXPECT_FALSE(std::signbit(round_affine<Real>({1, 0, 0, 0}, zero, 1, 1)));
  const Real least = std::numeric_limits<Real>::denorm_min();
  EXPECT_FALSE(std::signbit(round_affine<Real>({Real(-0.5), 0, 0, 0}, least, 0, 0)));
}

}  // namespace
}  // namespace pierce::exact
