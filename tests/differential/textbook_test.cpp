// SPDX-License-Identifier: Apache-2.0
//
// The library against what the textbooks say, word for word: every method of pierce/textbook.h that
// needs no epsilon, over exact rationals, one after the other on hard cases. Hit or miss, facing,
// and t, u, v, w to the bit.
#include "pierce/textbook.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <vector>

#include "pierce/intersect.h"
#include "support/hard_cases.h"
#include "support/rounding.h"
#include "support/run_cases.h"
#include "support/save_failure.h"
#include "support/show.h"
#include "support/shrink.h"

namespace pierce {
namespace {

using Rational = mpq_class;
using Method = textbook::Method<Rational>;

std::vector<Method> exact_methods() {
  std::vector<Method> exact;
  for (const Method& method : textbook::methods<Rational>()) {
    if (!method.epsilon) exact.push_back(method);
  }
  return exact;
}

template <class Real>
Hit<Real> by_the_book(const Method& method, const hard::Case<Real>& c) {
  const auto a = convert<Rational>(c.a), b = convert<Rational>(c.b),
             corner = convert<Rational>(c.c);
  const auto ray = convert<Rational>(c.ray);
  const auto hit = method.test(ray, a, b, corner);
  if (!hit) return {};
  using oracle::round_rational;
  const Rational w = 1 - hit->u - hit->v;
  const bool front = dot(cross(b - a, corner - a), ray.direction) < 0;
  return {round_rational<Real>(hit->t),
          round_rational<Real>(hit->u),
          round_rational<Real>(hit->v),
          round_rational<Real>(w),
          0,
          0,
          front ? Facing::Front : Facing::Back};
}

template <class Real>
Hit<Real> by_the_library(const Method& method, const hard::Case<Real>& c) {
  const auto hit = intersect(c.ray, c.a, c.b, c.c);
  const bool seen = hit && !(method.front_only && hit->facing == Facing::Back);
  return seen ? *hit : Hit<Real>{};
}

template <class Real>
class AgainstTheTextbook : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(AgainstTheTextbook, Reals);

TYPED_TEST(AgainstTheTextbook, every_method_over_rationals_says_what_the_library_says) {
  using Real = TypeParam;
  const auto methods = exact_methods();
  ASSERT_GE(methods.size(), 9U);
  const auto make = [](std::uint64_t i) {
    hard::Rng rng(hard::seed() + 8, i);
    auto c = hard::hard_case<Real>(rng);
    c.range = Range::Closed;
    return c;
  };
  const auto method_of = [&](std::uint64_t i) { return methods[i % methods.size()]; };
  const auto differs = [](const Method& method, const hard::Case<Real>& c) {
    return !show::same_bits(by_the_book(method, c), by_the_library(method, c));
  };
  const auto failure = hard::first_failure(
      hard::case_count(20000), [&](std::uint64_t i) { return differs(method_of(i), make(i)); });
  if (!failure) return;
  const Method method = method_of(*failure);
  const auto c = hard::shrunk(make(*failure), [&](const auto& x) { return differs(method, x); });
  FAIL() << "seed " << hard::seed() << " case " << *failure << ", " << method.name << "\n"
         << hard::saved(show::text(c)) << "\nbook:    " << show::text(by_the_book(method, c))
         << "\nlibrary: " << show::text(by_the_library(method, c));
}

}  // namespace
}  // namespace pierce
