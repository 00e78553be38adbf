// SPDX-License-Identifier: Apache-2.0
//
// Passages along an axis are those of crossings: held against decide_passage and
// decide_on_triangle on every style of number, most of all on lattices, where points lie above
// vertices, on edges and in planes all the time.
#include "predicate/axis_passage.h"

#include <gtest/gtest.h>

#include <array>

#include "predicate/passage.h"
#include "support/hard_cases.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce::predicate {
namespace {

using hard::Rng;
using hard::Style;

struct Tally {
  int on = 0, leaving = 0, entering = 0, none = 0;
  LadderCounts counts;
};

Vec3<double> direction(AxisDirection along) {
  Vec3<double> d{0, 0, 0};
  hard::component(d, along.axis) = along.forward ? 1 : -1;
  return d;
}

// All six directions from one point.
void expect_agreement(const Vec3<double>& point, const TriangleD& t, Tally& tally) {
  LadderCounts other;
  const bool on = decide_on_triangle(point, t);
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    for (const bool forward : {false, true}) {
      const AxisDirection along{axis, forward};
      const RayD ray{point, direction(along)};
      const AxisPassage found = decide_axis_passage(point, along, t, tally.counts);
      const Ray<double> shown{ray.origin, ray.direction};
      ASSERT_EQ(found == AxisPassage::OnTriangle, on)
          << show::text(shown) << show::text(t.a) << show::text(t.b) << show::text(t.c);
      if (on) {
        ++tally.on;
        continue;
      }
      const Passage expected = decide_passage(ray, t, other);
      ASSERT_EQ(static_cast<int>(found), static_cast<int>(expected))
          << show::text(shown) << show::text(t.a) << show::text(t.b) << show::text(t.c);
      ++(expected == Passage::None      ? tally.none
         : expected == Passage::Leaving ? tally.leaving
                                        : tally.entering);
    }
  }
}

// A point that is level with features of the triangle in one, two or three coordinates.
template <class Real>
Vec3<Real> level_point(Rng& rng, const hard::Case<Real>& hard) {
  Vec3<Real> p = hard::rounded_point<Real>(hard::detail::draw_target(rng, hard));
  if (!hard::is_finite(p)) p = hard.a;
  const std::array<Vec3<Real>, 3> corners{hard.a, hard.b, hard.c};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3<Real> corner = corners[rng.below(3)];
    if (rng.one_in(4)) hard::component(p, axis) = hard::component(corner, axis);
    if (rng.one_in(4)) {
      hard::component(p, axis) = hard::nudged(hard::component(p, axis), rng.between(-2, 2));
    }
  }
  return p;
}

template <class Real>
void run_style(Style style, std::uint64_t cases, Tally& tally) {
  for (std::uint64_t i = 0; i < cases; ++i) {
    Rng rng(hard::seed(), i);
    hard::Case<Real> hard;
    hard::detail::draw_triangle(rng, style, hard);
    const TriangleD t{to_double(hard.a), to_double(hard.b), to_double(hard.c)};
    const Vec3<Real> p = rng.one_in(4) ? hard::vec<Real>(rng, style) : level_point<Real>(rng, hard);
    expect_agreement(to_double(p), t, tally);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(AxisPassage, is_the_passage_of_crossings_for_every_style_of_number) {
  Tally tally;
  for (const Style style : hard::kAllStyles) {
    run_style<double>(style, hard::case_count(1500), tally);
    run_style<float>(style, hard::case_count(1500), tally);
    if (HasFatalFailure()) return;
  }
  if (hard::enough_cases(1500)) {
    EXPECT_GT(tally.on, 1000);
    EXPECT_GT(tally.leaving, 1000);
    EXPECT_GT(tally.entering, 1000);
    EXPECT_GT(tally.counts.certified, 10000U);
    EXPECT_GT(tally.counts.settled, 1000U);
    EXPECT_GT(tally.counts.settled_big, 1000U);
  }
}

// Small integers: every second point is above a vertex or an edge.
TEST(AxisPassage, is_the_passage_of_crossings_on_a_lattice) {
  Tally tally;
  for (std::uint64_t i = 0; i < hard::case_count(8000); ++i) {
    Rng rng(hard::seed(), i);
    const auto point = [&rng] {
      return Vec3<double>{double(rng.between(-2, 2)), double(rng.between(-2, 2)),
                          double(rng.between(-2, 2))};
    };
    const Vec3<double> p = point();
    const TriangleD t{point(), point(), point()};
    expect_agreement(p, t, tally);
    if (HasFatalFailure()) return;
  }
  if (hard::enough_cases(8000)) {
    EXPECT_GT(tally.on, 500);
    EXPECT_GT(tally.leaving, 300);
    EXPECT_GT(tally.entering, 300);
  }
}

// The price of a hard place: float data whose differences are exact never leave double for a side.
TEST(AxisPassage, sides_of_lattice_data_are_decided_in_double) {
  LadderCounts counts;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Rng rng(hard::seed(), i);
    const auto point = [&rng] {
      return Vec3<double>{double(rng.between(-3, 3)), double(rng.between(-3, 3)),
                          double(rng.between(-3, 3))};
    };
    const Vec3<double> p = point();
    const TriangleD t{point(), point(), point()};
    (void)decide_shadow(p, static_cast<std::uint8_t>(rng.below(3)), t, counts);
  }
  EXPECT_EQ(counts.certified, 2000U);
  EXPECT_EQ(counts.settled + counts.settled_big, 0U);
}

}  // namespace
}  // namespace pierce::predicate
