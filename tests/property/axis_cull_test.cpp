// SPDX-License-Identifier: Apache-2.0
//
// The traversal along an axis may only leave to nobody what is surely no passage, and count without
// asking what surely is one. Attacked through every kernel of this machine with points whose lines
// pass edges and vertices of shadows at distances of the size of the bounds, level with corners and
// in planes; every number either a float or one that is rounded as far as can be, corners floats
// also where points are not. 20,000 packets in ctest; the long run is
//   PIERCE_CASES=10000000 property_axis_cull_test
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <string>
#include <vector>

#include "kernels/points/axis.h"
#include "predicate/axis_passage.h"
#include "scene/points/axis_points.h"
#include "support/leaf_attacks.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using attack::Plan;
using hard::Rng;
using predicate::AxisDirection;
using predicate::AxisPassage;

struct PointsCase {
  std::vector<predicate::TriangleD> triangles;
  std::vector<Vec3<double>> points;
  AxisDirection along;
  bool exact = false;  // the corners are floats
};

// Exact for every point and triangle; remembers what it was asked.
class Recorder final : public kernels::AxisResolver {
 public:
  explicit Recorder(const PointsCase& c) : case_(c) {}

  [[nodiscard]] AxisPassage truth(std::uint32_t point, std::uint32_t triangle) {
    return predicate::decide_axis_passage(case_.points[point], case_.along,
                                          case_.triangles[triangle], counts_);
  }
  int passage(std::uint32_t point, const kernels::Candidate& candidate) override {
    asked[point] |= 1U << candidate.primitive;
    const AxisPassage answer = truth(point, candidate.primitive);
    return answer == AxisPassage::OnTriangle ? 0 : static_cast<int>(answer);
  }

  std::array<std::uint32_t, kernels::kAxisPoints> asked{};  // bit i: about triangle i

 private:
  const PointsCase& case_;
  predicate::LadderCounts counts_;
};

struct Seen {
  std::atomic<std::uint64_t> counted = 0, asked = 0, dropped = 0, on_triangle = 0;
};

// What the kernel gets wrong, or nothing.
std::string error_of(const kernels::Kernel& kernel, const bvh::Tree& tree, const PointsCase& c,
                     Seen& seen) {
  const space::FilterSpace identity;
  const scene::AxisSpace space(identity, tree, c.exact, false);
  kernels::AxisPacket packet;
  space.fill(c.points, c.along, packet);
  Recorder resolver(c);
  kernel.axis(tree, packet, resolver, nullptr);
  for (std::uint32_t i = 0; i < c.points.size(); ++i) {
    int winding = 0;
    for (std::uint32_t t = 0; t < c.triangles.size(); ++t) {
      const AxisPassage truth = resolver.truth(i, t);
      const bool asked = ((resolver.asked[i] >> t) & 1U) != 0;
      if (truth == AxisPassage::OnTriangle) {
        if (!asked) return std::string(kernel.name) + ": not asked about a point on a triangle";
        ++seen.on_triangle;
        continue;
      }
      winding += static_cast<int>(truth);
      ++(asked ? seen.asked : truth == AxisPassage::None ? seen.dropped : seen.counted);
    }
    if (packet.winding[i] != winding) {
      return std::string(kernel.name) + ": winding " + std::to_string(packet.winding[i]) +
             " instead of " + std::to_string(winding) + " for" + show::text(c.points[i]);
    }
  }
  return {};
}

// A point of a triangle's border or its inside, moved by about as much as the bounds are large.
Vec3<double> draw_point(Rng& rng, const PointsCase& c, const Plan& plan) {
  using attack::operator+;
  using attack::operator*;
  const predicate::TriangleD& t = c.triangles[rng.below(c.triangles.size())];
  if (rng.one_in(8)) return rng.coin() ? t.a : t.b;  // whose copies are rounded the other way
  const auto [u, v] = attack::draw_weights(rng);
  Vec3<double> p = (1 - u - v) * t.a + (u * t.b + v * t.c);
  const double reach = std::ldexp(1.0, -rng.between(22, plan.exact ? 24 + plan.size : 27));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& x = hard::component(p, axis);
    if (axis == c.along.axis && rng.coin()) {
      x = rng.symmetric();  // well before or behind
    } else {
      x += reach * rng.symmetric();
    }
    Vec3<double> corner = rng.coin() ? t.a : t.b;
    if (rng.one_in(8)) x = hard::component(corner, axis);
  }
  p = plan.exact ? attack::rounded(p) : attack::on_grid(attack::awkward(rng, p));
  const auto inside = [](double x) { return std::clamp(x, -1.0, 1.0); };
  return {inside(p.x), inside(p.y), inside(p.z)};
}

PointsCase draw_case(Rng& rng) {
  PointsCase c;
  c.exact = rng.one_in(3);
  const Plan plan{attack::Aim::DiscardHit, c.exact,
                  rng.one_in(4) ? rng.between(0, 25) : rng.between(0, 12)};
  const std::uint64_t triangles = rng.one_in(3) ? 1 + rng.below(8) : 1;
  for (std::uint64_t i = 0; i < triangles; ++i) {
    c.triangles.push_back(attack::draw_triangle(rng, plan));
  }
  c.along = {static_cast<std::uint8_t>(rng.below(3)), rng.coin()};
  const std::uint64_t points = 1 + rng.below(kernels::kAxisPoints);
  Plan of_points = plan;
  if (rng.one_in(3)) of_points.exact = false;
  for (std::uint64_t i = 0; i < points; ++i) c.points.push_back(draw_point(rng, c, of_points));
  return c;
}

TEST(AxisCull, no_passage_is_lost_and_none_is_made_up) {
  Seen seen;
  const auto run = [&](std::uint64_t i) {
    Rng rng(hard::seed(), i);
    const PointsCase c = draw_case(rng);
    const bvh::Tree tree =
        rng.coin() ? attack::one_leaf(c.triangles) : attack::one_node(c.triangles);
    std::string error;
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      if (error.empty()) error = error_of(*kernel, tree, c, seen);
    }
    return error;
  };
  const auto failure =
      hard::first_failure(hard::case_count(20000), [&](std::uint64_t i) { return run(i) != ""; });
  EXPECT_FALSE(failure) << "case " << *failure << ": " << run(*failure);
  if (hard::enough_cases(20000)) {
    EXPECT_GT(seen.counted, 5000U);
    EXPECT_GT(seen.asked, 5000U);
    EXPECT_GT(seen.dropped, 5000U);
    EXPECT_GT(seen.on_triangle, 200U);
  }
}

}  // namespace
}  // namespace pierce
