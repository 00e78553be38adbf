// SPDX-License-Identifier: Apache-2.0
//
// The oracle of `pierce check`, and the proof that the check can fail: its numbers are right, it
// leaves no triangle out, and a scene over another mesh is found out.
#include <gtest/gtest.h>

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "check/check_mesh.h"
#include "check/difference.h"
#include "check/exact.h"
#include "check/hard_meshes.h"
#include "check/hard_rays.h"
#include "check/lots.h"
#include "check/near_triangles.h"
#include "check/oracle.h"
#include "pierce/textbook.h"

namespace pierce::tool {
namespace {

using Rational = boost::multiprecision::cpp_rational;

double any_double(Lots& lots, int low, int high) {
  return std::ldexp(lots.symmetric(), lots.between(low, high));
}

TEST(Exact, double_comes_back_as_it_was) {
  const double kLowest = std::numeric_limits<double>::denorm_min();
  for (const double x :
       {0.0, 1.0, -1.5, 0.1, kLowest, -3 * kLowest, 0x1p-1022, 0x1.fffffffffffffp1023}) {
    EXPECT_EQ(round_to<double>(Exact(x)), x);
  }
  EXPECT_FALSE(std::signbit(round_to<double>(Exact(-0.0))));
}

TEST(Exact, arithmetic_agrees_with_rationals) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Lots lots(1, i);
    const double a = any_double(lots, -60, 60), b = any_double(lots, -60, 60),
                 c = any_double(lots, -60, 60), d = any_double(lots, -60, 60);
    if (c == 0 || d == 0) continue;
    const Exact x = (Exact(a) * Exact(b) - Exact(c)) / Exact(d) + Exact(a) / Exact(c);
    const Rational y =
        (Rational(a) * Rational(b) - Rational(c)) / Rational(d) + Rational(a) / Rational(c);
    EXPECT_EQ(x.sign(), y.sign());
    // Exactly equal, not only nearly: the difference from a double at hand has the same sign.
    const double near = static_cast<double>(y);
    EXPECT_EQ(compare(x, Exact(near)), y.compare(Rational(near)));
  }
}

// The last bit of the number is 0.
template <class Real>
bool is_even(Real x) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  return std::bit_cast<Bits>(x) % 2 == 0;
}

// Nearest by definition: no neighbour is nearer, and of two equally near the even one is taken.
template <class Real>
void expect_nearest(const Exact& x, Real got) {
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  ASSERT_TRUE(std::isfinite(got));
  const auto distance = [&](Real r) {
    const Exact d = x - Exact(static_cast<double>(r));
    return d < 0 ? -d : d;
  };
  for (const Real other : {std::nextafter(got, kInf), std::nextafter(got, -kInf)}) {
    if (!std::isfinite(other)) continue;
    const int order = compare(distance(got), distance(other));
    EXPECT_LE(order, 0);
    if (order == 0) {
      EXPECT_TRUE(is_even(got));
    }
  }
}

template <class Real>
void rounds_to_nearest(int low, int high) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Lots lots(2, i);
    const double a = any_double(lots, low, high), b = any_double(lots, 0, 3);
    if (b == 0) continue;
    expect_nearest(Exact(a) / Exact(b), round_to<Real>(Exact(a) / Exact(b)));
    // Halfway between two neighbours.
    const Real x = static_cast<Real>(a);
    const Real y = std::nextafter(x, std::numeric_limits<Real>::infinity());
    const Exact middle = (Exact(static_cast<double>(x)) + Exact(static_cast<double>(y))) / 2;
    expect_nearest(middle, round_to<Real>(middle));
  }
}

TEST(Exact, rounds_to_the_nearest_float_normal_and_denormal) {
  rounds_to_nearest<float>(-40, 40);
  rounds_to_nearest<float>(-150, -120);
}

TEST(Exact, rounds_to_the_nearest_double_normal_and_denormal) {
  rounds_to_nearest<double>(-40, 40);
  rounds_to_nearest<double>(-1074, -1015);
}

TEST(Exact, overflow_is_infinite_from_half_an_ulp_on) {
  const double kMax = std::numeric_limits<double>::max();
  const Exact half_ulp(0x1p970);
  EXPECT_EQ(round_to<double>(Exact(kMax) + half_ulp), INFINITY);
  EXPECT_EQ(round_to<double>(Exact(kMax) + half_ulp - Exact(0x1p-1000)), kMax);
  EXPECT_EQ(round_to<float>(-Exact(0x1p200)), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(round_to<float>(Exact(0x1p-160)), 0);
  EXPECT_EQ(round_to<float>(Exact(0x1p-150)), 0);  // a tie: to even
  EXPECT_EQ(round_to<float>(Exact(0x1.8p-150)), 0x1p-149F);
}

// Every generated mesh: what the cull leaves out is not hit by any method over rationals.
template <class Real>
void leaves_nothing_out() {
  std::uint64_t left_out = 0, hits = 0;
  for (const HardMeshKind& kind : hard_mesh_kinds()) {
    HardMesh<Real> mesh = make_hard_mesh<Real>(kind.name);
    if (mesh.triangles.size() > 200) mesh.triangles.resize(200);
    const NearTriangles near(mesh.view());
    const HardRays<Real> rays(mesh.view(), 3);
    for (std::uint64_t i = 0; i < 8; ++i) {
      const Ray<Real> ray = rays(i);
      std::vector<std::uint32_t> found;
      near.find(ray, found);
      const std::set<std::uint32_t> kept(found.begin(), found.end());
      EXPECT_EQ(kept.size(), found.size());
      const auto exact_ray = convert<Rational>(ray);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto corner = [&](int k) {
          return convert<Rational>(mesh.vertices[mesh.triangles[t][static_cast<std::size_t>(k)]]);
        };
        const bool hit =
            textbook::plane_then_barycentric(exact_ray, corner(0), corner(1), corner(2))
                .has_value();
        hits += hit ? 1 : 0;
        left_out += kept.count(t) == 0 ? 1 : 0;
        EXPECT_TRUE(!hit || kept.count(t) == 1) << kind.name << ", ray " << i << ", triangle " << t;
      }
    }
  }
  EXPECT_GT(left_out, 5000U);
  EXPECT_GT(hits, 200U);
}

TEST(NearTriangles, leave_out_nothing_that_is_hit_in_float) { leaves_nothing_out<float>(); }
TEST(NearTriangles, leave_out_nothing_that_is_hit_in_double) { leaves_nothing_out<double>(); }

TEST(Oracle, hits_are_in_order_and_those_at_the_start_are_counted) {
  const std::vector<Vec3<double>> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                              {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const std::vector<Triangle> triangles = {{3, 4, 5}, {0, 1, 2}, {0, 2, 1}};
  const Oracle<double> oracle({vertices, triangles});
  const auto answer = oracle.ask({{0.25, 0.25, 0}, {0, 0, 2}});
  ASSERT_EQ(answer.hits.size(), 3U);
  EXPECT_EQ(answer.at_start, 2U);
  EXPECT_EQ(answer.hits[0], (Hit<double>{0, 0.25, 0.25, 0.5, 0, 1, Facing::Back}));
  EXPECT_EQ(answer.hits[1], (Hit<double>{0, 0.25, 0.25, 0.5, 0, 2, Facing::Front}));
  EXPECT_EQ(answer.hits[2], (Hit<double>{0.5, 0.25, 0.25, 0.5, 0, 0, Facing::Back}));
}

// What infinity became by way of integers was -1024.
TEST(Oracle, no_hit_lies_at_a_start_that_is_infinite) {
  const std::vector<Vec3<double>> vertices{{0, 0, -1024}, {1, 0, -1024}, {0, 1, -1024}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const Oracle<double> oracle({vertices, triangles});
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const auto answer = oracle.ask({{0.25, 0.25, 0}, {0, 0, 1}, -kInf, kInf});
  ASSERT_EQ(answer.hits.size(), 1U);
  EXPECT_EQ(answer.hits[0].t, -1024);
  EXPECT_EQ(answer.at_start, 0U);
  EXPECT_THROW(Exact{kInf}, std::invalid_argument);
}

TEST(Oracle, passage_through_a_vertex_is_one_and_a_touch_is_none_or_two) {
  // A tetrahedron.
  const std::vector<Vec3<double>> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const Oracle<double> oracle({vertices, triangles});
  const auto crossings = [&](const Ray<double>& ray) { return oracle.ask(ray).crossings; };
  EXPECT_EQ(crossings({{0.1, 0.1, 0.1}, {1, 0, 0}}), (Crossings{1, 1, false}));
  EXPECT_EQ(crossings({{0.1, 0.1, 0.1}, {-0.1, -0.1, -0.1}}), (Crossings{1, 1, false}));
  EXPECT_EQ(crossings({{-1, -1, -1}, {1, 1, 1}}), (Crossings{2, 0, false}));
  EXPECT_EQ(crossings({{-1, 0, 0}, {1, 0, 0}}).signed_count, 0);  // along an edge
  EXPECT_EQ(crossings({{0, 0, 0}, {1, 1, 1}}), (Crossings{1, 1, true}));
  EXPECT_EQ(crossings({{0.25, 0.25, 0}, {0, 0, -1}}), (Crossings{1, 1, true}));
  EXPECT_EQ(crossings({{0.25, 0.25, 1}, {0, 0, -1}, 0, 0.5}), (Crossings{0, 0, false}));
}

TEST(Oracle, point_on_a_triangle_without_area_is_on_the_surface) {
  const std::vector<Vec3<double>> vertices = {{0, 0, 0}, {2, 2, 2}, {1, 1, 1}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 1, 1}};
  const Oracle<double> oracle({vertices, triangles});
  const auto on_surface = [&](const Vec3<double>& p) {
    return oracle.ask({p, {1, 0, 0}}).crossings.origin_on_surface;
  };
  EXPECT_TRUE(on_surface({0.5, 0.5, 0.5}));
  EXPECT_TRUE(on_surface({2, 2, 2}));
  EXPECT_FALSE(on_surface({2.5, 2.5, 2.5}));
  EXPECT_FALSE(on_surface({0.5, 0.5, 0.25}));
}

TEST(HardRays, are_valid_and_follow_from_seed_and_index) {
  for (const HardMeshKind& kind : hard_mesh_kinds()) {
    const HardMesh<float> mesh = make_hard_mesh<float>(kind.name);
    const HardRays<float> rays(mesh.view(), 5), again(mesh.view(), 5);
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Ray<float> ray = rays(i);
      EXPECT_TRUE(std::isfinite(ray.origin.x) && std::isfinite(ray.direction.z)) << kind.name;
      EXPECT_TRUE(ray.direction != (Vec3<float>{0, 0, 0}));
      EXPECT_EQ(ray.direction, again(i).direction);
    }
  }
}

TEST(HardMeshes, all_have_triangles) {
  for (const HardMeshKind& kind : hard_mesh_kinds()) {
    EXPECT_GE(make_hard_mesh<float>(kind.name).triangles.size(), 1U) << kind.name;
    EXPECT_EQ(make_hard_mesh<double>(kind.name).triangles.size(),
              make_hard_mesh<float>(kind.name).triangles.size());
  }
}

TEST(Difference, one_bit_is_a_difference) {
  Hit<float> a{1, 0, 0, 1, 0, 7, Facing::Front};
  Hit<float> b = a;
  EXPECT_TRUE(identical(a, b));
  b.u = -0.0F;
  EXPECT_FALSE(identical(a, b));
  b = a;
  b.t = std::nextafter(1.0F, 2.0F);
  EXPECT_FALSE(identical(a, b));
  b = a;
  b.facing = Facing::Back;
  EXPECT_FALSE(identical(a, b));
}

TEST(CheckMesh, scene_over_another_mesh_is_found_out_and_the_first_difference_is_told) {
  const HardMesh<float> mesh = make_hard_mesh<float>("sphere");
  HardMesh<float> other = mesh;
  other.vertices[100].x = std::nextafter(other.vertices[100].x, 2.0F);
  const auto right = Scene<float>::build(mesh.view());
  const auto wrong = Scene<float>::build(other.view());
  const CheckOptions options = {.rays = 2000};
  const std::vector<MeshView<float>> meshes = {mesh.view()};
  EXPECT_EQ(check_mesh<float>("sphere", meshes, right, options).differences, 0U);
  const CheckResult found = check_mesh<float>("sphere", meshes, wrong, options);
  EXPECT_GT(found.differences, 0U);
  for (const char* part : {"sphere: first difference: ", "  ray      ", "0x", "  expected ",
                           "  got      ", "  see: pierce triangle --triangle="}) {
    EXPECT_NE(found.first.find(part), std::string::npos) << part << "\n" << found.first;
  }
}

}  // namespace
}  // namespace pierce::tool
