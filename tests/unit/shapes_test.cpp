// SPDX-License-Identifier: Apache-2.0
//
// Rays with planes, spheres, polygons and triangles: the first hit in the range, closed boundaries,
// exact over rationals; and how well the sphere holds where the schoolbook formula fails.
#include "pierce/shapes.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "pierce/textbook.h"
#include "support/rng.h"

namespace pierce {
namespace {

using shapes::ConvexPolygon;
using shapes::Plane;
using shapes::Polygon;
using shapes::Shape;
using shapes::Sphere;

using Q = mpq_class;
using Wide = boost::multiprecision::cpp_bin_float_100;

// The schoolbook formula, which is fine with a hundred digits.
std::optional<Wide> first_t(const Sphere<double>& sphere, const Ray<double>& ray) {
  const auto d = convert<Wide>(ray.direction);
  const Vec3<Wide> f = convert<Wide>(ray.origin) - convert<Wide>(sphere.centre);
  const Wide a = dot(d, d), b = dot(f, d), c = dot(f, f) - Wide(sphere.radius) * sphere.radius;
  const Wide discriminant = b * b - a * c;
  if (discriminant < 0) return std::nullopt;
  const Wide root = sqrt(discriminant);
  const Wide first = (-b - root) / a, second = (-b + root) / a;
  if (first >= 0) return first;
  return second >= 0 ? std::optional<Wide>(second) : std::nullopt;
}

template <class S>
std::optional<S> t_of(const std::optional<shapes::SurfaceHit<S>>& hit) {
  return hit ? std::optional<S>(hit->t) : std::nullopt;
}

TEST(Shapes, all_are_asked_in_one_way) {
  const std::vector<Vec3<double>> square = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<Shape<double>> all = {
      Plane<double>{{0, 0, 0}, {0, 0, 2}}, Sphere<double>{{0, 0, -1}, 1},
      ConvexPolygon<double>{square}, Polygon<double>{square},
      shapes::Triangle<double>{square[0], square[1], square[2]}};
  const Ray<double> ray = {{0, 0, 3}, {0, 0, -1}};
  for (const Shape<double>& shape : all) {
    const auto hit = intersect(shape, ray);
    ASSERT_TRUE(hit) << shape.index();
    EXPECT_EQ(hit->t, 3) << shape.index();
    EXPECT_EQ(shapes::point_at(ray, hit->t), (Vec3<double>{0, 0, 0})) << shape.index();
    EXPECT_GT(hit->normal.z, 0) << shape.index();
    EXPECT_EQ(hit->normal.x, 0) << shape.index();
    EXPECT_FALSE(intersect(shape, Ray<double>{{0, 0, 3}, {0, 0, -1}, 0, 2.5})) << shape.index();
    EXPECT_FALSE(intersect(shape, Ray<double>{{0, 0, 3}, {0, 0, 1}})) << shape.index();
  }
}

TEST(Shapes, a_ray_in_a_plane_does_not_hit_it) {
  const Plane<Q> plane = {{0, 0, 1}, {1, 1, 1}};
  EXPECT_EQ(t_of(intersect(plane, Ray<Q>{{0, 0, 0}, {1, 1, 1}})), Q(1) / 3);
  EXPECT_FALSE(intersect(plane, Ray<Q>{{0, 0, 1}, {1, -1, 0}}));
  EXPECT_FALSE(intersect(plane, Ray<Q>{{0, 0, 0}, {1, -1, 0}}));
}

TEST(Shapes, spheres_of_any_size_neither_over_nor_underflow) {
  for (const int k : {-80, -40, 0, 30, 66, 120}) {
    const float size = std::ldexp(1.0F, k);
    const auto hit = intersect(Sphere<float>{{0, 0, 0}, size},
                               Ray<float>{{0, 0, -5 * size}, {0, 0, std::ldexp(1.0F, k / 2)}});
    ASSERT_TRUE(hit) << k;
    EXPECT_EQ(hit->t, 4 * std::ldexp(1.0F, k - k / 2)) << k;
    EXPECT_EQ(hit->normal, (Vec3<float>{0, 0, -size})) << k;
  }
  // Far smaller than it is far away: passed at three radii, at nine tenths of one.
  const Ray<float> beside{{3e-25F, 0, -1}, {0, 0, 1}}, within{{0.9e-25F, 0, -1}, {0, 0, 1}};
  EXPECT_FALSE(intersect(Sphere<float>{{0, 0, 0}, 1e-25F}, beside));
  EXPECT_TRUE(intersect(Sphere<float>{{0, 0, 0}, 1e-25F}, within));
}

TEST(Shapes, a_sphere_is_hit_where_the_ray_enters_or_else_where_it_leaves) {
  const Sphere<double> sphere = {{1, 2, 3}, 2};
  const Vec3<double> along = {0, 0, 1};
  const auto from_outside = intersect(sphere, Ray<double>{{1, 2, -2}, along});
  ASSERT_TRUE(from_outside);
  EXPECT_EQ(from_outside->t, 3);
  EXPECT_EQ(from_outside->normal, (Vec3<double>{0, 0, -2}));
  const auto from_inside = intersect(sphere, Ray<double>{{1, 2, 3}, along});
  ASSERT_TRUE(from_inside);
  EXPECT_EQ(from_inside->t, 2);
  EXPECT_EQ(from_inside->normal, (Vec3<double>{0, 0, 2})) << "outwards also from inside";
  EXPECT_FALSE(intersect(sphere, Ray<double>{{1, 2, 6}, along})) << "the sphere is behind";
  EXPECT_EQ(t_of(intersect(sphere, Ray<double>{{1, 2, 6}, along, -10})), -5);
  EXPECT_EQ(t_of(intersect(sphere, Ray<double>{{1, 2, -2}, along, 3.5})), 7);
}

TEST(Shapes, a_touch_of_the_sphere_is_a_hit) {
  const Sphere<double> sphere = {{0, 0, 0}, 1};
  EXPECT_EQ(t_of(intersect(sphere, Ray<double>{{-3, 1, 0}, {2, 0, 0}})), 1.5);
  EXPECT_EQ(t_of(intersect(sphere, Ray<double>{{0, 1, 0}, {2, 0, 0}})), 0) << "where it starts";
  EXPECT_FALSE(intersect(sphere, Ray<double>{{-3, std::nextafter(1.0, 2.0), 0}, {2, 0, 0}}));
  EXPECT_EQ(t_of(intersect(Sphere<double>{{5, 0, 0}, 0}, Ray<double>{{0, 0, 0}, {1, 0, 0}})), 5)
      << "a sphere of radius 0 is a point";
}

TEST(Shapes, far_and_large_spheres_are_hit_to_a_few_ulp_of_their_distance) {
  double worst = 0, worst_of_schoolbook = 0;
  int hits = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    hard::Rng rng(5, i);
    const double far = std::ldexp(1.0, rng.between(0, 20));
    const Sphere<double> sphere = {{rng.symmetric(), rng.symmetric(), far},
                                   rng.coin() ? 1.0 : far - 1};
    const Ray<double> ray = {{0, 0, 0}, {rng.symmetric() / far, rng.symmetric() / far, 1}};
    const auto hit = intersect(sphere, ray);
    const auto exact = first_t(sphere, ray);
    ASSERT_EQ(hit.has_value(), exact.has_value()) << i;
    if (!hit) continue;
    ++hits;
    const Vec3<double>& d = ray.direction;
    const Vec3<double> f = ray.origin - sphere.centre;
    const double scale = std::sqrt(dot(f, f) / dot(d, d));  // the distance of the centre
    const auto off = [&](double t) {
      return static_cast<double>(abs(Wide(t) - *exact)) / scale * 0x1p53;
    };
    worst = std::max(worst, off(hit->t));

    const double a = dot(d, d), b = 2 * dot(f, d), c = dot(f, f) - sphere.radius * sphere.radius;
    const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
    worst_of_schoolbook = std::max(worst_of_schoolbook, off((-b - root) / (2 * a)));
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(worst, 3.1);  // as measured
  EXPECT_GT(worst_of_schoolbook, 6.8e6);
}

TEST(Shapes, a_polygon_of_any_shape_is_hit_inside_and_on_its_boundary_and_nowhere_else) {
  // An L with a slanting roof; asked exactly, on a lattice that meets edges and corners.
  const std::vector<Vec3<Q>> corners = {{0, 0, 0}, {6, 0, 6}, {6, 2, 6},
                                        {2, 2, 2}, {2, 6, 2}, {0, 4, 0}};
  std::vector<Vec3<Q>> reversed(corners.rbegin(), corners.rend());
  const auto inside = [](int x, int y) {  // in quarters
    const bool foot = x >= 0 && x <= 24 && y >= 0 && y <= 8;
    const bool leg = x >= 0 && x <= 8 && y >= 0 && y <= 16 + x;
    return foot || leg;
  };
  int hits = 0;
  for (int x = -4; x <= 28; ++x) {
    for (int y = -4; y <= 28; ++y) {
      const Ray<Q> ray = {{Q(x) / 4, Q(y) / 4, 10}, {0, 0, -1}};
      const auto hit = intersect(Polygon<Q>{corners}, ray);
      ASSERT_EQ(hit.has_value(), inside(x, y)) << x << " " << y;
      ASSERT_EQ(t_of(hit), t_of(intersect(Polygon<Q>{reversed}, ray))) << x << " " << y;
      if (!hit) continue;
      ++hits;
      EXPECT_EQ(hit->t, 10 - Q(x) / 4);
    }
  }
  EXPECT_GT(hits, 200);
}

TEST(Shapes, convex_polygons_have_the_same_hits_by_either_method) {
  const std::vector<Vec3<Q>> hexagon = {{2, 0, 0}, {4, 0, 1}, {6, 2, 3},
                                        {4, 4, 3}, {2, 4, 2}, {0, 2, 0}};
  ASSERT_EQ(dot(textbook::vector_area<Q>(hexagon), hexagon[3] - hexagon[0]), 0) << "it is planar";
  int hits = 0;
  for (int x = -2; x <= 14; ++x) {
    for (int y = -2; y <= 10; ++y) {
      const Ray<Q> ray = {{Q(x) / 2, Q(y) / 2, -9}, {0, 0, 3}};
      const auto one = intersect(ConvexPolygon<Q>{hexagon}, ray);
      ASSERT_EQ(t_of(one), t_of(intersect(Polygon<Q>{hexagon}, ray))) << x << " " << y;
      if (one) ++hits;
    }
  }
  EXPECT_GT(hits, 50);
}

TEST(Shapes, a_polygon_without_area_is_never_hit) {
  const std::vector<std::vector<Vec3<double>>> flat = {
      {}, {{0, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}};
  const Ray<double> ray = {{0.5, 0, 1}, {0, 0, -1}};
  for (const auto& corners : flat) {
    EXPECT_FALSE(intersect(ConvexPolygon<double>{corners}, ray));
    EXPECT_FALSE(intersect(Polygon<double>{corners}, ray));
  }
}

TEST(Shapes, a_triangle_of_floats_is_decided_exactly) {
  // The ray that all textbook methods but one lose between this triangle and its neighbour.
  const shapes::Triangle<float> triangle = {{2, -4, 3}, {-1, 2, -4}, {1, 1, -3}};
  const Ray<float> ray = {{0, -3, 8}, {0x1.0264fp-4f, 0x1.634acap-2f, -0x1.df1b28p-1f}};
  const auto hit = intersect(triangle, ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 11.888807503820932816f);
  EXPECT_FALSE(textbook::determinants(ray, triangle.a, triangle.b, triangle.c));
}

}  // namespace
}  // namespace pierce
