// SPDX-License-Identifier: Apache-2.0
//
// What each textbook method is known to get wrong, as tests with the numbers. The numbers were
// found by a program that drew random cases on a coarse lattice and kept the first or the worst;
// the exact answers beside them are computed here, over GMP rationals. A method that changes and
// mends one of these is welcome: then the page about it must change as well.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "pierce/textbook.h"

namespace pierce {
namespace {

using Point = Vec3<float>;
using Corners = std::array<Point, 3>;
using Answer = std::optional<TextbookHit<float>>;

std::optional<TextbookHit<mpq_class>> exact(const Ray<float>& ray, const Corners& p) {
  return textbook::cramer(convert<mpq_class>(ray), convert<mpq_class>(p[0]),
                          convert<mpq_class>(p[1]), convert<mpq_class>(p[2]));
}

Answer ask(std::string_view name, const Ray<float>& ray, const Corners& p) {
  for (const textbook::Method<float>& method : textbook::methods<float>()) {
    if (method.name == name) return method.test(ray, p[0], p[1], p[2]);
  }
  ADD_FAILURE() << "no method is called " << name;
  return std::nullopt;
}

std::vector<std::string_view> two_sided_methods() {
  std::vector<std::string_view> names;
  for (const auto& method : textbook::methods<float>()) {
    if (!method.front_only) names.push_back(method.name);
  }
  return names;
}

TEST(TextbookFailures, all_but_watertight_miss_both_triangles_at_a_shared_edge) {
  // The edge is that from (1, 1, -3) to (-1, 2, -4); the ray passes beside it with w = 2e-8.
  const Ray<float> ray = {{0, -3, 8}, {0x1.0264fp-4f, 0x1.634acap-2f, -0x1.df1b28p-1f}};
  const Corners one = {{{4, 0, 0}, {1, 1, -3}, {-1, 2, -4}}};
  const Corners other = {{{2, -4, 3}, {-1, 2, -4}, {1, 1, -3}}};
  EXPECT_FALSE(exact(ray, one));
  const auto hit = exact(ray, other);
  ASSERT_TRUE(hit);
  EXPECT_GT(1 - hit->u - hit->v, 0) << "beside the edge, not on it";
  for (const std::string_view name : two_sided_methods()) {
    EXPECT_FALSE(ask(name, ray, other)) << name;
    EXPECT_EQ(ask(name, ray, one).has_value(), name == "watertight") << name;
  }
}

TEST(TextbookFailures, watertight_gives_a_ray_to_the_wrong_one_of_two_neighbours) {
  const Ray<float> ray = {{0.25f, 1, 3}, {-0x1.4bc182p-4f, -0x1.f59556p-3f, -0x1.eeabf8p-1f}};
  const Point a = {-1.25f, 0.125f, 0.375f}, b = {-1.125f, -1.75f, 0.625f}, c = {0, 0, -1},
              d = {1, 1.5f, 1.625f};
  EXPECT_TRUE(exact(ray, {a, b, c}));
  EXPECT_FALSE(exact(ray, {a, c, d}));
  EXPECT_FALSE(ask("watertight", ray, {a, b, c}));
  EXPECT_TRUE(ask("watertight", ray, {a, c, d}));
}

TEST(TextbookFailures, watertight_misses_both_where_rounding_folds_a_neighbour_over) {
  // The first triangle is seen all but edge-on (N.d = -1e-8). Sheared and rounded, its corner
  // (-4, -4, -1) lies on the other side of the edge, the same side as the second triangle.
  const Ray<float> ray = {{4, -4, 7}, {-0x1.4525a6p-1f, 0x1.7398bep-5f, -0x1.8ad24ap-1f}};
  const Corners one = {{{-4, -4, -1}, {-3, -4, 0}, {-3, -3, -3}}};
  const Corners other = {{{-3, -3, -3}, {-3, -4, 0}, {4, -2, 0}}};
  EXPECT_FALSE(exact(ray, one));
  EXPECT_TRUE(exact(ray, other));
  for (const std::string_view name : two_sided_methods()) {
    EXPECT_FALSE(ask(name, ray, one)) << name;
    EXPECT_FALSE(ask(name, ray, other)) << name;
  }
}

TEST(TextbookFailures, the_order_of_the_corners_decides_whether_precomputed_normal_leaks) {
  const Ray<float> ray = {{0, 0.875f, 3}, {0x1.ffc5a2p-3f, 0x1.43e806p-3f, -0x1.e9193cp-1f}};
  const Point a = {0.25f, -0.75f, -1.5f}, b = {-1.5f, -1.75f, 0.75f}, c = {1.375f, 2, -1.75f},
              d = {1.875f, 1.875f, 1.5f};
  EXPECT_TRUE(exact(ray, {a, b, c}));
  EXPECT_FALSE(exact(ray, {a, c, d}));
  // Both start at the same end of the edge ac: the wrong one of the two, but one of them.
  EXPECT_FALSE(ask("precomputed_normal", ray, {a, b, c}));
  EXPECT_TRUE(ask("precomputed_normal", ray, {a, c, d}));
  EXPECT_FALSE(ask("precomputed_normal", ray, {c, d, a})) << "now neither is hit";
}

TEST(TextbookFailures, moller_trumbore_with_its_epsilon_does_not_see_a_triangle_of_3_mm_in_metres) {
  const Corners small = {{{0, 0, 0}, {0.003f, 0, 0}, {0, 0.003f, 0}}};
  const Ray<float> ray = {{0.001f, 0.001f, 1}, {0, 0, -1}};
  EXPECT_TRUE(exact(ray, small));
  EXPECT_FALSE(ask("moller_trumbore", ray, small));
  EXPECT_FALSE(ask("moller_trumbore_culling", ray, small));
  EXPECT_TRUE(ask("moller_trumbore, epsilon 0", ray, small));
  EXPECT_TRUE(ask("moller_trumbore_culling, epsilon 0", ray, small));
  // The limit is on e1.q = 9e-6 here, whose unit is that of d times an area: a longer d is seen.
  const Ray<float> longer = {ray.origin, {0, 0, -2}};
  EXPECT_TRUE(ask("moller_trumbore", longer, small));
}

TEST(TextbookFailures, moller_trumbore_with_its_epsilon_does_not_see_a_large_triangle_aslant) {
  // A floor of 100 m^2, seen from 3 um above it 100 m away: e1.q = 3e-6 although N is 100.
  const Corners floor = {{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}}};
  const Ray<float> ray = {{-100, 2, 3e-6f}, {1, 0, -0x1p-25f}};
  EXPECT_TRUE(exact(ray, floor));
  EXPECT_FALSE(ask("moller_trumbore", ray, floor));
  EXPECT_TRUE(ask("moller_trumbore, epsilon 0", ray, floor));
}

struct Slanting {
  std::string_view method;
  Corners corners;
  Ray<float> ray;
};

TEST(TextbookFailures, every_method_without_an_epsilon_has_false_hits_far_outside_the_triangle) {
  // Rays all but in the plane, whose N.d is mostly rounding. The exact u or v is off by more than
  // 30 triangle widths.
  const Corners p = {{{-1, -0.25f, -0.875f}, {-1.25f, 0.625f, -0.875f}, {-0.125f, 1.75f, -1.25f}}};
  const Ray<float> along_p = {{0x1.9cb2dcp+0f, -0x1.40d354p+2f, -0x1.330c32p+0f},
                              {-0x1.fd5be2p-2f, 0x1.baebbap-1f, 0x1.09c0a2p-4f}};
  const Corners q = {{{1.625f, -1.875f, 1.125f}, {0.125f, 1.25f, -0.75f}, {0.5f, -0.25f, -0.875f}}};
  const Ray<float> along_q = {{0x1.726128p+1f, -0x1.37ee0cp+2f, 0x1.35549p+1f},
                              {-0x1.810312p-2f, 0x1.9fd01ep-1f, -0x1.c8e182p-2f}};
  const std::vector<Slanting> cases = {
      {"cramer", p, along_p},
      {"moller_trumbore, epsilon 0", p, along_p},
      {"plane_then_edges", q, along_q},
      {"plane_then_barycentric", q, along_q},
      {"determinants",
       {{{0.75f, 0.375f, 0}, {-1.625f, -0.125f, -0.625f}, {1, -0.75f, -0.875f}}},
       {{0x1.c22c4p+2f, 0x1.d017ep+0f, 0x1.bed814p+0f},
        {-0x1.983bp-1f, -0x1.baba94p-2f, -0x1.af3ab8p-2f}}},
      {"precomputed_normal",
       {{{-1.5f, 1.25f, 1.25f}, {0.5f, -1.625f, 1.75f}, {-2, 0.5f, -1.625f}}},
       {{0x1.4bd002p+1f, -0x1.c44024p+2f, -0x1.2451ccp+1f},
        {-0x1.f7a004p-2f, 0x1.b6804ap-1f, 0x1.41472ep-3f}}},
      {"watertight",
       {{{-2, -1.5f, -1.5f}, {1.25f, 0.75f, 1.125f}, {0.875f, -1.75f, 0.625f}}},
       {{-0x1.062314p+0f, -0x1.dcefd6p-1f, -0x1.7134ap-1f},
        {0x1.996cb8p-1f, 0x1.df5392p-6f, 0x1.33118ap-1f}}},
      {"baldwin_weber",
       {{{-1.375f, 0.75f, 1.375f}, {0.125f, 0.875f, -1.25f}, {-2, 1.625f, 1.25f}}},
       {{-0x1.4c484p-5f, 0x1.3ce2ep+1f, -0x1.8a94a2p+1f},
        {-0x1.4227a8p-2f, -0x1.2d07aep-2f, 0x1.ce1b82p-1f}}},
  };
  for (const auto& [method, corners, ray] : cases) {
    EXPECT_FALSE(exact(ray, corners)) << method;
    const Answer claimed = ask(method, ray, corners);
    ASSERT_TRUE(claimed) << method;
    EXPECT_LT(claimed->t, 7) << method;
    // The plane itself is met more than a hundred units of t away.
    const auto& [a, b, c] = corners;
    const Vec3<mpq_class> n = cross(convert<mpq_class>(b) - convert<mpq_class>(a),
                                    convert<mpq_class>(c) - convert<mpq_class>(a));
    const mpq_class t = dot(n, convert<mpq_class>(a) - convert<mpq_class>(ray.origin)) /
                        dot(n, convert<mpq_class>(ray.direction));
    EXPECT_GT(abs(t), 100) << method;
  }
}

TEST(TextbookFailures, rays_in_the_plane_are_called_hits) {
  const std::vector<Slanting> cases = {
      {"watertight",  // eighths and sixteenths only: nothing but the shear is rounded
       {{{-1.75f, 1, -0.625f}, {-0.25f, 0.125f, -1.625f}, {0.5f, -1.75f, 0.25f}}},
       {{-0.625f, 0.34375f, -1.375f}, {1.125f, -1.375f, 0.4375f}}},
      {"plane_then_edges",
       {{{1.5f, 1.375f, -0.875f}, {-0.125f, -1.625f, 0.25f}, {1.25f, -1.75f, 1}}},
       {{0x1.1f9784p+0f, 0x1.c6fp-7f, -0x1.82a9ap-3f},
        {-0x1.cf2f08p-2f, -0x1.ab8dep-1f, 0x1.40aa68p-2f}}},
      {"plane_then_barycentric",
       {{{1.5f, 1.375f, -0.875f}, {-0.125f, -1.625f, 0.25f}, {1.25f, -1.75f, 1}}},
       {{0x1.1f9784p+0f, 0x1.c6fp-7f, -0x1.82a9ap-3f},
        {-0x1.cf2f08p-2f, -0x1.ab8dep-1f, 0x1.40aa68p-2f}}},
      {"precomputed_normal",
       {{{0.75f, 0.875f, 0.75f}, {0, -1.75f, 0.125f}, {0.25f, -1.125f, 1.25f}}},
       {{0x1.1d4822p-2f, -0x1.d56fbcp-1f, 0x1.c15bfp-1f},
        {0x1.e2b7dep-3f, 0x1.e2b7dep-1f, -0x1.e2b7dep-3f}}},
      {"baldwin_weber",
       {{{-0.25f, 0.375f, -0.5f}, {-1.875f, 0.875f, 1.75f}, {1.375f, 0.375f, 0}}},
       {{0x1.142a18p-1f, 0x1.a3a448p-2f, -0x1.0d04p-4f},
        {-0x1.beb8b2p-1f, 0x1.12e7dp-3f, 0x1.e115acp-2f}}},
      {"cramer",
       {{{1.375f, 1.625f, 0.75f}, {1.625f, 0.375f, -1.5f}, {-0.25f, 1.5f, 1.375f}}},
       {{0x1.396f38p+2f, -0x1.b5908p-1f, -0x1.516f38p+2f},
        {-0x1.62de7p-1f, 0x1.95908p-3f, 0x1.62de7p-1f}}},
      {"moller_trumbore, epsilon 0",
       {{{1.375f, 1.625f, 0.75f}, {1.625f, 0.375f, -1.5f}, {-0.25f, 1.5f, 1.375f}}},
       {{0x1.396f38p+2f, -0x1.b5908p-1f, -0x1.516f38p+2f},
        {-0x1.62de7p-1f, 0x1.95908p-3f, 0x1.62de7p-1f}}},
      {"determinants",
       {{{1.25f, 1.5f, 0.5f}, {-1.75f, -1.125f, 0.5f}, {1.25f, -1.875f, -1}}},
       {{-0x1.179762p+2f, -0x1.379762p+3f, -0x1.279762p+1f},
        {0x1.bee906p-2f, 0x1.bee906p-1f, 0x1.bee906p-3f}}},
  };
  for (const auto& [method, corners, ray] : cases) {
    const auto q = [](const Point& x) { return convert<mpq_class>(x); };
    const auto& [a, b, c] = corners;
    EXPECT_EQ(dot(cross(q(b) - q(a), q(c) - q(a)), q(ray.direction)), 0) << method;
    EXPECT_TRUE(ask(method, ray, corners)) << method;
  }
}

TEST(TextbookFailures, all_but_watertight_miss_a_hit_in_the_middle_of_a_triangle_seen_edge_on) {
  const Ray<float> ray = {{0x1.1ef476p-1f, -0x1.5519e2p-1f, 0x1.7407f4p+1f},
                          {0x1.80d608p-3f, -0x1.561394p-5f, -0x1.f66cc2p-1f}};
  const Corners p = {{{1.875f, -1.5f, 0.625f}, {1.5f, -0.875f, -2}, {0, 0, 1.25f}}};
  const auto hit = exact(ray, p);
  ASSERT_TRUE(hit);
  EXPECT_GT(hit->u, 0.36);
  EXPECT_GT(hit->v, 0.31);
  EXPECT_GT(1 - hit->u - hit->v, 0.31);
  for (const std::string_view name : two_sided_methods()) {
    EXPECT_EQ(ask(name, ray, p).has_value(), name == "watertight") << name;
  }
  const Answer rounded = ask("watertight", ray, p);
  ASSERT_TRUE(rounded);
  EXPECT_GT(mpq_class(rounded->t) - hit->t, 0.38) << "found, but t is 3.48 instead of 3.09";
}

TEST(TextbookFailures,
     methods_that_round_the_point_or_the_map_fail_far_from_the_coordinate_origin) {
  // The same triangle of size 1 and the same ray near (1e5, 1e5, 1e5).
  const float far = 100000;
  const Corners p = {
      {{far + 0.1f, far, far}, {far + 1, far + 0.1f, far + 0.2f}, {far, far + 1, far + 0.3f}}};
  const Ray<float> ray = {{far + 0.3f, far + 0.2f, far + 3}, {0.1f, 0.05f, -1}};
  const auto hit = exact(ray, p);
  ASSERT_TRUE(hit);
  for (const std::string_view name : two_sided_methods()) {
    const Answer rounded = ask(name, ray, p);
    ASSERT_TRUE(rounded) << name;
    const double error = std::abs(static_cast<double>(rounded->u) - hit->u.get_d());
    const bool rounds_far_numbers = name.starts_with("plane") || name == "baldwin_weber";
    if (rounds_far_numbers) {
      EXPECT_GT(error, 4e-4) << name;
    } else {
      EXPECT_LT(error, 1e-7) << name;
    }
  }
}

TEST(TextbookFailures, products_of_small_and_of_large_coordinates_leave_the_range_of_float) {
  const auto scaled = [](int exponent) {
    const float s = std::ldexp(1.0f, exponent);
    return std::pair(Ray<float>{{s / 4, s / 4, s}, {0, 0, -1}},
                     Corners{{{0, 0, 0}, {s, 0, 0}, {0, s, 0}}});
  };
  const auto [tiny_ray, tiny] = scaled(-75);  // 2.6e-23, squared under the smallest float
  const auto [huge_ray, huge] = scaled(64);   // 1.8e19, squared over the largest
  const auto [far_ray, far] = scaled(40);     // 1.1e12: to the fourth power, over the largest
  EXPECT_EQ(exact(tiny_ray, tiny)->u, mpq_class(0.25));
  EXPECT_EQ(exact(huge_ray, huge)->u, mpq_class(0.25));
  EXPECT_EQ(exact(far_ray, far)->u, mpq_class(0.25));
  for (const std::string_view name : two_sided_methods()) {
    EXPECT_FALSE(ask(name, tiny_ray, tiny)) << name;
    EXPECT_EQ(ask(name, huge_ray, huge).has_value(), name == "baldwin_weber") << name;
    const Answer hit = ask(name, far_ray, far);
    ASSERT_TRUE(hit) << name;
    EXPECT_EQ(std::isnan(hit->u), name == "plane_then_edges") << name;
  }
  EXPECT_EQ(ask("baldwin_weber", huge_ray, huge)->u, 0) << "instead of 1/4";
}

}  // namespace
}  // namespace pierce
