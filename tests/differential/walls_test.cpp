// SPDX-License-Identifier: Apache-2.0
//
// Buildings: floors and walls, as they are and as a part that was turned by 90 degrees, of whose
// zeros sine and cosine made 1e-17. Rays start on faces, edges and corners, end there, or move
// along axes; and some numbers are so small that filter space cannot hold them. Against the
// oracle, bit by bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "support/compare_scene.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::AimedRay;
using hard::component;
using hard::Mesh;
using hard::Rng;

// The turn and the size of a part.
struct Place {
  double sine, cosine, size;
  int axis;

  explicit Place(Rng& rng) : axis(rng.between(0, 2)) {
    const double turn = rng.one_in(3) ? 0 : (rng.coin() ? 0.5 : rng.coin() ? 1 : 0.25);
    sine = turn == 0 ? 0 : std::sin(turn * std::numbers::pi);
    cosine = turn == 0 ? 1 : std::cos(turn * std::numbers::pi);
    size = std::ldexp(1.0, rng.one_in(4) ? rng.between(-90, 90) : rng.between(-8, 8));
  }
  template <class Real>
  [[nodiscard]] Vec3<Real> direction(Vec3<double> p) const {
    const double i = component(p, (axis + 1) % 3), j = component(p, (axis + 2) % 3);
    component(p, (axis + 1) % 3) = cosine * i - sine * j;
    component(p, (axis + 2) % 3) = sine * i + cosine * j;
    return {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)};
  }
  template <class Real>
  [[nodiscard]] Vec3<Real> point(const Vec3<double>& p) const {
    return direction<Real>({size * p.x, size * p.y, size * p.z});
  }
};

// A parallelogram of n times n cells of two triangles.
template <class Real>
void add_wall(Mesh<Real>& mesh, const Place& place, const Vec3<double>& o, const Vec3<double>& e,
              const Vec3<double>& f, std::uint32_t n) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
      mesh.add(place.point<Real>(
          {o.x + u * e.x + v * f.x, o.y + u * e.y + v * f.y, o.z + u * e.z + v * f.z}));
    }
  }
  for (std::uint32_t k = 0; k < n * n; ++k) {
    const std::uint32_t a = first + k / n * (n + 1) + k % n;
    mesh.triangles.push_back({a, a + 1, a + n + 2});
    mesh.triangles.push_back({a, a + n + 2, a + n + 1});
  }
}

template <class Real>
Mesh<Real> buildings(Rng& rng, const Place& place) {
  const int bits = rng.coin() ? 3 : rng.between(4, std::numeric_limits<Real>::digits);
  const auto number = [&] {
    return std::ldexp(std::floor(std::ldexp(rng.symmetric(), bits)), -bits);
  };
  Mesh<Real> mesh;
  add_wall(mesh, place, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0},
           static_cast<std::uint32_t>(rng.between(1, 4)));
  for (int i = rng.between(1, 3); i > 0; --i) {
    const double x = rng.one_in(4) ? 0 : number(), y = number();
    const double w = std::fabs(number()), d = std::fabs(number()), h = std::fabs(number());
    const auto n = static_cast<std::uint32_t>(rng.between(1, 2));
    add_wall(mesh, place, {x, y, 0}, {w, 0, 0}, {0, 0, h}, n);
    add_wall(mesh, place, {x, y + d, 0}, {w, 0, 0}, {0, 0, h}, n);
    add_wall(mesh, place, {x, y, 0}, {0, d, 0}, {0, 0, h}, n);
    add_wall(mesh, place, {x + w, y, 0}, {0, d, 0}, {0, 0, h}, n);
    add_wall(mesh, place, {x, y, h}, {w, 0, 0}, {0, d, 0}, n);
  }
  return mesh;
}

// Far below what a float of filter space can be, or 0.
template <class Real>
Real tiny_number(Rng& rng, double size) {
  if (rng.one_in(4)) return std::numeric_limits<Real>::denorm_min();
  if (rng.one_in(4)) return rng.coin() ? Real(0) : -Real(0);
  return static_cast<Real>(size * std::ldexp(rng.symmetric(), -rng.between(60, 160)));
}

template <class Real>
Ray<Real> ray_among(Rng& rng, const Mesh<Real>& mesh, const Place& place) {
  const auto any_vertex = [&] { return mesh.vertices[rng.below(mesh.vertices.size())]; };
  const auto& [i, j, k] = mesh.triangles[rng.below(mesh.triangles.size())];
  double u = rng.one_in(3) ? rng.between(0, 2) / 2.0 : rng.unit() / 2;
  const double v = rng.one_in(3) ? 0 : rng.unit() / 2;
  if (rng.one_in(6)) u = 0;
  const auto on_triangle = [&](int axis) {
    const auto at = [&](std::uint32_t n) {
      Vec3<Real> vertex = mesh.vertices[n];
      return static_cast<double>(component(vertex, axis));
    };
    return static_cast<Real>((1 - u - v) * at(i) + u * at(j) + v * at(k));
  };
  Vec3<Real> p{on_triangle(0), on_triangle(1), on_triangle(2)};
  Vec3<Real> o = place.point<Real>({rng.symmetric(), rng.symmetric(), 1 + rng.unit()});
  if (rng.one_in(6)) o = any_vertex();
  Vec3<Real> other = any_vertex();
  for (int axis = 0; axis < 3; ++axis) {
    if (rng.one_in(6)) component(p, axis) = component(other, axis);
    if (rng.one_in(12)) component(p, axis) = tiny_number<Real>(rng, place.size);
    if (rng.one_in(12)) component(o, axis) = tiny_number<Real>(rng, place.size);
  }
  const auto step = [&] { return static_cast<double>(rng.between(-1, 1)); };
  Vec3<Real> d = place.direction<Real>({step(), step(), step()});
  if (rng.coin()) d = place.direction<Real>({rng.symmetric(), rng.symmetric(), rng.symmetric()});
  const auto between = [](const Vec3<Real>& from, const Vec3<Real>& to) {
    return Ray<Real>{from, {to.x - from.x, to.y - from.y, to.z - from.z}};
  };
  Ray<Real> ray = rng.one_in(3) ? between(o, p) : Ray<Real>{p, d};
  if (rng.one_in(4)) ray = {o, place.direction<Real>({0, 0, -1})};
  if (rng.one_in(6)) ray = between(p, o);
  if (rng.one_in(3)) ray.t_max = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (rng.one_in(12)) component(ray.direction, axis) = tiny_number<Real>(rng, 1);
  }
  if (ray.direction == Vec3<Real>{0, 0, 0}) ray.direction.z = 1;
  return ray;
}

template <class Real>
class Walls : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Walls, Reals);

TYPED_TEST(Walls, rays_that_start_and_end_on_them) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(60); ++i) {
    Rng rng(hard::seed(), 900 + i);
    const Place place(rng);
    const Mesh<Real> mesh = buildings<Real>(rng, place);
    const oracle::BruteForce<Real> truth(mesh.view());
    std::vector<AimedRay<Real>> rays;
    for (int k = 0; k < 60; ++k) {
      Ray<Real> ray = ray_among(rng, mesh, place);
      if (rng.one_in(4)) {  // as far as its first hit, or all but, or from there on
        const auto hits = truth.all_hits(ray);
        if (!hits.empty()) {
          const Real t = hard::nudged(hits.front().t, rng.between(-1, 1));
          (rng.coin() ? ray.t_max : ray.t_min) = t;
        }
      }
      rays.push_back(hard::with_any_range(rng, mesh, ray));
    }
    const auto found = oracle::difference(mesh, rays);
    ASSERT_FALSE(found) << "seed " << hard::seed() << " case " << i << "\n" << *found;
  }
}

// What is lost of an origin on the way to filter space is much of its way to a wall next to it.
TEST(Walls, a_ray_along_an_axis_starts_next_to_a_wall) {
  Mesh<float> mesh;
  mesh.add({0, -1, -1});
  mesh.add({0, 3, -1});
  mesh.add({0, -1, 3});
  mesh.add({8, 0, 0});
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const Ray<float> ray{{0x1.868p-140F, 0, 0}, {-0x1.edb9a6p+1F, 0, 0}, 0, 0x1.96p-142F};
  const auto found = oracle::difference_on_one_ray(Scene<float>::build(mesh.view()),
                                                   oracle::BruteForce<float>(mesh.view()), ray);
  EXPECT_FALSE(found) << *found;
}

}  // namespace
}  // namespace pierce
