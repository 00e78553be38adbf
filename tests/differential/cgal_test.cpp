// SPDX-License-Identifier: Apache-2.0
//
// CGAL's exact kernel as a witness from outside: its line-triangle intersection decides hit or
// miss, its point of intersection gives t. The only file that includes CGAL, which compiles slowly.
#include <CGAL/Gmpq.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "pierce/intersect.h"
#include "support/hard_cases.h"
#include "support/quick_oracle.h"
#include "support/run_cases.h"
#include "support/save_failure.h"
#include "support/show.h"
#include "support/shrink.h"

namespace pierce {
namespace {

using Exact = CGAL::Gmpq;
using Kernel = CGAL::Simple_cartesian<Exact>;

struct CgalHit {
  Exact t;
  Facing facing;
};

template <class Real>
Kernel::Point_3 point(const Vec3<Real>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Negative, zero, positive: t before, at, after the bound.
template <class Real>
int compare_to(const Exact& t, Real bound) {
  if (std::isinf(bound)) return bound > 0 ? -1 : 1;
  return CGAL::compare(t, Exact(static_cast<double>(bound)));
}

template <class Real>
std::optional<CgalHit> cgal_hit(const hard::Case<Real>& c) {
  const Kernel::Triangle_3 triangle(point(c.a), point(c.b), point(c.c));
  if (triangle.is_degenerate()) return std::nullopt;
  const Kernel::Vector_3 d = point(c.ray.direction) - CGAL::ORIGIN;
  const Kernel::Vector_3 normal = triangle.supporting_plane().orthogonal_vector();
  const auto towards = CGAL::sign(normal * d);
  if (towards == CGAL::ZERO) return std::nullopt;
  const Kernel::Point_3 o = point(c.ray.origin);
  const auto common = CGAL::intersection(Kernel::Line_3(o, d), triangle);
  if (!common) return std::nullopt;
  const Kernel::Point_3 p = boost::get<Kernel::Point_3>(*common);
  const Kernel::Vector_3 op = p - o;
  const int axis = d.x() != 0 ? 0 : d.y() != 0 ? 1 : 2;
  const Exact t = op[axis] / d[axis];
  const int start = compare_to(t, c.ray.t_min);
  if (start < 0 || (start == 0 && c.range == Range::OpenStart)) return std::nullopt;
  if (compare_to(t, c.ray.t_max) > 0) return std::nullopt;
  return CgalHit{t, towards == CGAL::NEGATIVE ? Facing::Front : Facing::Back};
}

template <class Real>
class AgainstCgal : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(AgainstCgal, Reals);

template <class Real>
bool differs(const hard::Case<Real>& c) {
  const auto truth = cgal_hit(c);
  const auto found = intersect(c.ray, c.a, c.b, c.c, c.range);
  if (truth.has_value() != found.has_value()) return true;
  if (!truth) return false;
  const mpq_class t(truth->t.mpq());
  return truth->facing != found->facing ||
         !show::same_bits(oracle::round_rational<Real>(t), found->t);
}

TYPED_TEST(AgainstCgal, hits_facing_and_t_agree) {
  using Real = TypeParam;
  const auto make = [](std::uint64_t i) {
    hard::Rng rng(hard::seed() + 5, i);
    return hard::hard_case<Real>(rng);
  };
  const auto failure = hard::first_failure(hard::case_count(20000),
                                           [&](std::uint64_t i) { return differs(make(i)); });
  if (failure) {
    const auto c = hard::shrunk(make(*failure), differs<Real>);
    const auto found = intersect(c.ray, c.a, c.b, c.c, c.range);
    FAIL() << "seed " << hard::seed() + 5 << " case " << *failure << "\n"
           << hard::saved(show::text(c)) << "\nfound: " << show::text(found.value_or(Hit<Real>{}));
  }
}

// The order of two hits of a line, as exact numbers.
TYPED_TEST(AgainstCgal, the_oracle_orders_two_hits_alike) {
  using Real = TypeParam;
  int compared = 0, equal = 0;
  for (std::uint64_t i = 0; i < hard::case_count(10000); ++i) {
    hard::Rng rng(hard::seed() + 6, i);
    hard::Case<Real> first = hard::hard_case<Real>(rng);
    hard::Case<Real> second = first;
    Vec3<Real>& moved = rng.coin() ? second.a : second.b;
    Real& x = hard::component(moved, rng.below(3));
    x = hard::nudged(x, rng.between(-2, 2));
    const auto p = cgal_hit(first), q = cgal_hit(second);
    if (!p || !q) continue;
    const auto r = oracle::LineAndTriangle(first.ray, first.a, first.b, first.c);
    const auto s = oracle::LineAndTriangle(second.ray, second.a, second.b, second.c);
    ASSERT_EQ(compare_t(r.hit_numbers(), s.hit_numbers()), int(CGAL::compare(p->t, q->t)))
        << show::text(first) << show::text(second);
    ++compared;
    equal += p->t == q->t ? 1 : 0;
  }
  if (hard::enough_cases(10000)) {
    EXPECT_GT(compared, 500);
    EXPECT_GT(equal, 50);
    EXPECT_GT(compared - equal, 50);
  }
}

}  // namespace
}  // namespace pierce
