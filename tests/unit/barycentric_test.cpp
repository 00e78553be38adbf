// SPDX-License-Identifier: Apache-2.0
//
// Barycentric coordinates of triangles, tetrahedra and simplices of any dimension: exact over a
// rational, the same from every formula, and what their signs and zeros mean.
#include "pierce/barycentric.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>

#include "support/rng.h"

namespace pierce {
namespace {

using Q = mpq_class;

Q small_rational(hard::Rng& rng) { return Q(rng.between(-12, 12)) / rng.between(1, 7); }

template <std::size_t n>
std::array<Q, n> random_point(hard::Rng& rng) {
  std::array<Q, n> p;
  for (Q& x : p) x = small_rational(rng);
  return p;
}

// Weights that add up to 1, some of them 0 or negative.
template <std::size_t corners>
std::array<Q, corners> random_weights(hard::Rng& rng) {
  std::array<Q, corners> weights;
  weights[0] = 1;
  for (std::size_t i = 1; i < corners; ++i) {
    weights[i] = rng.one_in(4) ? Q(0) : small_rational(rng);
    weights[0] -= weights[i];
  }
  return weights;
}

template <std::size_t corners, std::size_t n>
void expect_weights_come_back() {
  int found = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    hard::Rng rng(corners * 10 + n, i);
    std::array<std::array<Q, n>, corners> simplex;
    for (auto& corner : simplex) corner = random_point<n>(rng);
    const auto weights = random_weights<corners>(rng);
    const auto coordinates = barycentric(interpolate(weights, simplex), simplex);
    if (!coordinates) continue;
    ++found;
    EXPECT_EQ(*coordinates, weights);
  }
  EXPECT_GT(found, 150) << "few random simplices have no size";
}

TEST(Barycentric, a_weighted_mean_of_the_corners_has_its_weights_as_coordinates) {
  expect_weights_come_back<2, 1>();  // a segment on a line
  expect_weights_come_back<2, 3>();
  expect_weights_come_back<3, 2>();  // a triangle in the plane
  expect_weights_come_back<3, 3>();
  expect_weights_come_back<3, 5>();
  expect_weights_come_back<4, 3>();  // a tetrahedron
  expect_weights_come_back<4, 4>();
  expect_weights_come_back<6, 5>();
  expect_weights_come_back<6, 8>();
}

TEST(Barycentric, the_special_forms_agree_with_the_general_one) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    hard::Rng rng(1, i);
    std::array<std::array<Q, 3>, 4> corners;
    for (auto& corner : corners) corner = random_point<3>(rng);
    const std::array<Q, 3> p = random_point<3>(rng);
    const auto vec2 = [](const std::array<Q, 3>& x) { return Vec2<Q>{x[0], x[1]}; };
    const auto vec3 = [](const std::array<Q, 3>& x) { return Vec3<Q>{x[0], x[1], x[2]}; };
    const auto& [a, b, c, d] = corners;

    const auto flat = [](const std::array<Q, 3>& x) { return std::array<Q, 2>{x[0], x[1]}; };
    EXPECT_EQ(barycentric(vec2(p), vec2(a), vec2(b), vec2(c)),
              barycentric(flat(p), std::array{flat(a), flat(b), flat(c)}));
    EXPECT_EQ(barycentric(vec3(p), vec3(a), vec3(b), vec3(c)), barycentric(p, std::array{a, b, c}))
        << "a point beside the plane has the coordinates of its projection";
    EXPECT_EQ(barycentric(vec3(p), vec3(a), vec3(b), vec3(c), vec3(d)), barycentric(p, corners));
  }
}

TEST(Barycentric, a_simplex_without_size_has_no_coordinates) {
  const Vec2<double> a = {0, 0}, b = {1, 1}, c = {3, 3};
  EXPECT_FALSE(barycentric(a, a, b, c));
  const Vec3<double> p = {0, 0, 0}, q = {1, 2, 3}, r = {2, 4, 6}, s = {1, 0, 0};
  EXPECT_FALSE(barycentric(p, p, q, r));
  EXPECT_FALSE(barycentric(p, p, q, r, s));
  using P = std::array<double, 3>;
  EXPECT_FALSE(barycentric(P{0, 0, 0}, std::array{P{1, 2, 3}, P{1, 2, 3}}));
  EXPECT_FALSE(barycentric(P{0, 0, 0}, std::array{P{0, 0, 0}, P{1, 2, 3}, P{2, 4, 6}}));
}

TEST(Barycentric, ordinary_floating_point_coordinates_are_within_a_few_ulp) {
  const Vec3<double> a = {0, 0, 1}, b = {4, 0, 1}, c = {0, 3, 2};
  const std::array<double, 3> weights = {0.2, 0.3, 0.5};
  const Vec3<double> p = interpolate(weights, std::array{a, b, c});
  const auto coordinates = barycentric(p, a, b, c);
  ASSERT_TRUE(coordinates);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ((*coordinates)[i], weights[i]);
}

TEST(Barycentric, a_zero_coordinate_means_the_face_opposite_and_two_a_vertex) {
  const Vec2<Q> a = {0, 0}, b = {6, 0}, c = {0, 6};
  const auto carrier_of = [&](const Vec2<Q>& p) {
    const auto corners = carrier(*barycentric(p, a, b, c));
    return corners ? corners->to_string() : "outside";  // c, b, a from left to right
  };
  EXPECT_EQ(carrier_of(a), "001");
  EXPECT_EQ(carrier_of(b), "010");
  EXPECT_EQ(carrier_of(c), "100");
  EXPECT_EQ(carrier_of({3, 0}), "011");
  EXPECT_EQ(carrier_of({3, 3}), "110");
  EXPECT_EQ(carrier_of({0, 5}), "101");
  EXPECT_EQ(carrier_of({2, 2}), "111");
  EXPECT_EQ(carrier_of({4, 3}), "outside");
  EXPECT_EQ(carrier_of({7, 0}), "outside") << "on the line of an edge, beyond its end";
}

TEST(Barycentric, a_triangle_has_seven_regions_and_a_tetrahedron_fifteen) {
  std::array<bool, 8> regions = {};
  for (int x = -1; x <= 4; ++x) {
    for (int y = -1; y <= 4; ++y) {
      const auto l = *barycentric(Vec2<Q>{x, y}, Vec2<Q>{0, 0}, Vec2<Q>{2, 0}, Vec2<Q>{0, 2});
      regions[beyond(l).to_ulong()] = true;
      EXPECT_EQ(beyond(l).none(), inside_closed(l));
    }
  }
  EXPECT_EQ(std::count(regions.begin(), regions.end(), true), 7);
  EXPECT_FALSE(regions[7]) << "not all coordinates are negative: they add up to 1";

  std::array<bool, 16> cells = {};
  for (std::uint64_t i = 0; i < 500; ++i) {
    hard::Rng rng(3, i);
    cells[beyond(random_weights<4>(rng)).to_ulong()] = true;
  }
  EXPECT_EQ(std::count(cells.begin(), cells.end(), true), 15);
}

TEST(Barycentric, edges_belong_to_the_closed_simplex_and_not_to_the_open_one) {
  using L = std::array<Q, 3>;
  const Q third = Q(1) / 3;
  EXPECT_TRUE(inside_open(L{third, third, third}));
  EXPECT_TRUE(inside_closed(L{third, third, third}));
  EXPECT_FALSE(inside_open(L{0, third, 1 - third}));
  EXPECT_TRUE(inside_closed(L{0, third, 1 - third}));
  EXPECT_FALSE(inside_closed(L{-third, third, 1}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(inside_closed(std::array{nan, 0.5, 0.5})) << "a NaN is nowhere";
}

TEST(Barycentric, attributes_are_interpolated_linearly) {
  const std::array<double, 3> l = {0.5, 0.25, 0.25};
  EXPECT_EQ(interpolate(l, std::array{1.0, 2.0, 4.0}), 2.0);
  EXPECT_EQ(interpolate(
                l, std::array{Vec3<double>{4, 0, 0}, Vec3<double>{0, 4, 0}, Vec3<double>{0, 0, 4}}),
            (Vec3<double>{2, 1, 1}));
  using Color = std::array<double, 4>;
  EXPECT_EQ(interpolate(l, std::array{Color{1, 0, 0, 1}, Color{0, 1, 0, 1}, Color{0, 0, 1, 1}}),
            (Color{0.5, 0.25, 0.25, 1}));
}

}  // namespace
}  // namespace pierce
