// SPDX-License-Identifier: Apache-2.0
//
// Where points lie, against oracles that share nothing with the library: the brute-force one over
// exact numbers, the lattice itself, and on the bunny the solid angles of all triangles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/hard_rays.h"
#include "support/located.h"
#include "support/outliers.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::located;
using hard::Mesh;
using hard::Rng;
using hard::Style;

// Points that are level with vertices in one, two or three coordinates, on features, and anywhere.
template <class Real>
Vec3<Real> hard_point(Rng& rng, const Mesh<Real>& mesh) {
  const auto any_vertex = [&] { return mesh.vertices[rng.below(mesh.vertices.size())]; };
  Vec3<Real> p = hard::aimed_ray(rng, mesh, Style::Unit).ray.origin;
  if (rng.coin()) {  // exactly or nearly on a triangle
    const Triangle& t = mesh.triangles[rng.below(mesh.triangles.size())];
    hard::Case<Real> c;
    c.a = mesh.vertices[t[0]];
    c.b = mesh.vertices[t[1]];
    c.c = mesh.vertices[t[2]];
    p = hard::rounded_point<Real>(hard::detail::draw_target(rng, c));
  }
  if (!hard::is_finite(p)) p = any_vertex();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3<Real> vertex = any_vertex();
    if (rng.one_in(3)) hard::component(p, axis) = hard::component(vertex, axis);
  }
  return p;
}

template <class Real>
class Locate : public testing::Test {
 public:
  static void expect_exact(const std::string& name, const Mesh<Real>& mesh,
                           const std::vector<Vec3<Real>>& points, const BuildOptions& build = {}) {
    const auto scene = Scene<Real>::build(mesh.view(), build);
    const oracle::BruteForce<Real> truth(mesh.view());
    const auto batch = located(scene, points);
    const auto alone = located(scene, points, {.work = {.threads = 1}});
    const auto up = located(scene, points, {.open_mesh = true});
    ASSERT_EQ(batch, alone) << name;
    ASSERT_EQ(batch, up) << name << ": looking up instead of for the nearest exit";
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(batch[i], truth.locate(points[i])) << name << show::text(points[i]);
      ASSERT_EQ(batch[i], scene.locate(points[i])) << name << show::text(points[i]);
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Locate, Reals);

TYPED_TEST(Locate, hard_points_of_closed_meshes_are_where_exact_numbers_say) {
  using Real = TypeParam;
  for (const Quality quality :
       {Quality::Balanced, Quality::High, Quality::Fast, Quality::Compact}) {
    for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
      Rng rng(hard::seed(), static_cast<std::uint64_t>(quality));
      std::vector<Vec3<Real>> points;
      for (int i = 0; i < 60; ++i) points.push_back(hard_point(rng, mesh));
      this->expect_exact(name, mesh, points, {.quality = quality});
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

TYPED_TEST(Locate, detail_beside_something_huge_is_located_exactly) {
  using Real = TypeParam;
  for (auto [name, mesh] : hard::small_closed_meshes<Real>()) {
    for (std::uint64_t i = 0; i < 3; ++i) {
      Rng rng(hard::seed() + 15, i);
      std::vector<Vec3<Real>> points;
      for (int k = 0; k < 30; ++k) points.push_back(hard_point(rng, mesh));
      Mesh<Real> beside = mesh;
      hard::add_outlier(rng, beside);
      for (int k = 0; k < 10; ++k) points.push_back(hard_point(rng, beside));
      this->expect_exact(name, beside, points, {.quality = static_cast<Quality>(rng.below(4))});
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

// The same meshes elsewhere: moved far away (the copies in the leaves are then rounded), made tiny
// or huge.
TYPED_TEST(Locate, moved_and_scaled_meshes_are_no_harder) {
  using Real = TypeParam;
  for (auto [name, mesh] : hard::small_closed_meshes<Real>()) {
    Rng rng(hard::seed(), 2);
    for (const auto& [scale, shift] :
         {std::pair<Real, Real>{64, 512345}, {Real(0x1p-60), 0}, {Real(0x1p60), Real(0x1p50)}}) {
      Mesh<Real> moved = mesh;
      for (auto& v : moved.vertices) {
        v = {v.x * scale + shift, v.y * scale + shift, v.z * scale - shift};
      }
      std::vector<Vec3<Real>> points;
      for (int i = 0; i < 60; ++i) points.push_back(hard_point(rng, moved));
      this->expect_exact(name, moved, points);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

// Doubles that are no floats, within a float's rounding of the edges of triangles that are small
// beside the scene and whose corners are floats.
TEST(LocateDoubles, points_between_floats_are_not_moved_across_edges_of_floats) {
  std::array<int, 3> seen{};
  for (std::uint64_t i = 0; i < hard::case_count(100); ++i) {
    Rng rng(hard::seed(), i);
    Mesh<double> mesh;
    const auto add_tetrahedron = [&](double place, double size) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto number = [&] {
        return static_cast<double>(static_cast<float>(place + size * rng.unit()));
      };
      for (int k = 0; k < 4; ++k) mesh.vertices.push_back({number(), number(), number()});
      for (const Triangle& t : {Triangle{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}}) {
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
    };
    add_tetrahedron(-0.9, 0.1);
    add_tetrahedron(0.6, std::ldexp(1.0, -rng.between(5, 12)));
    const auto scene = Scene<double>::build(mesh.view());
    const oracle::BruteForce<double> truth(mesh.view());
    std::vector<Vec3<double>> points;
    for (int k = 0; k < 30; ++k) {
      const auto& a = mesh.vertices[4 + rng.below(4)];
      const auto& b = mesh.vertices[4 + rng.below(4)];
      const double w = rng.unit();
      const auto beside = [&](double x, double y) {
        return x + w * (y - x) + 0x1p-26 * rng.symmetric();
      };
      points.push_back({beside(a.x, b.x), beside(a.y, b.y), beside(a.z, b.z)});
    }
    const auto locations = located(scene, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_EQ(locations[k], truth.locate(points[k])) << i << show::text(points[k]);
      ++seen[static_cast<std::size_t>(1 + static_cast<int>(locations[k]))];
    }
  }
  if (hard::enough_cases(100)) {
    EXPECT_GT(seen[0], 100);
    EXPECT_GT(seen[2], 100);
  }
}

// With the open-mesh option anything will do: the answer is that of crossings along +z.
TYPED_TEST(Locate, open_meshes_of_every_style_are_what_the_crossings_along_z_say) {
  using Real = TypeParam;
  int on_surface = 0, inside = 0, twice = 0;
  for (std::uint64_t i = 0; i < hard::case_count(140); ++i) {
    Rng rng(hard::seed(), i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    auto mesh = hard::soup<Real>(rng, style, static_cast<std::uint32_t>(1 + rng.below(40)));
    if (rng.one_in(3)) mesh = hard::copies(rng, mesh, 1 + rng.between(1, 3));
    if (rng.one_in(4)) hard::add_outlier(rng, mesh);
    const auto scene =
        Scene<Real>::build(mesh.view(), {.quality = static_cast<Quality>(rng.below(4))});
    const oracle::BruteForce<Real> truth(mesh.view());
    std::vector<Vec3<Real>> points;
    for (int k = 0; k < 12; ++k) points.push_back(hard_point(rng, mesh));
    const auto odd = located(scene, points, {.open_mesh = true});
    const auto wound = located(scene, points, {.rule = InsideRule::NonZero, .open_mesh = true});
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Crossings crossings = truth.crossings({points[k], {0, 0, 1}});
      const auto expected = [&](bool is_inside) {
        return crossings.origin_on_surface ? Location::OnSurface
               : is_inside                 ? Location::Inside
                                           : Location::Outside;
      };
      ASSERT_EQ(odd[k], expected(crossings.count % 2 != 0)) << i << show::text(points[k]);
      ASSERT_EQ(wound[k], expected(crossings.signed_count != 0)) << i << show::text(points[k]);
      on_surface += crossings.origin_on_surface ? 1 : 0;
      inside += odd[k] == Location::Inside ? 1 : 0;
      twice += odd[k] != wound[k] ? 1 : 0;
    }
  }
  if (hard::enough_cases(140)) {
    EXPECT_GT(on_surface, 100);
    EXPECT_GT(inside, 50);
    EXPECT_GT(twice, 5);
  }
}

TYPED_TEST(Locate, every_vertex_is_on_the_surface) {
  using Real = TypeParam;
  auto meshes = hard::small_closed_meshes<Real>();
  meshes.push_back({"bunny", hard::bunny<Real>()});
  for (const auto& [name, mesh] : meshes) {
    const auto scene = Scene<Real>::build(mesh.view());
    const auto batch = located(scene, mesh.vertices);
    std::vector<bool> used(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) used[t[0]] = used[t[1]] = used[t[2]] = true;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (used[i]) {
        ASSERT_EQ(batch[i], Location::OnSurface) << name << show::text(mesh.vertices[i]);
      }
    }
  }
}

// In a lattice cube, midpoints of edges and quarter points of faces are numbers of the type.
TYPED_TEST(Locate, representable_points_of_edges_and_faces_are_on_the_surface) {
  using Real = TypeParam;
  Rng rng(hard::seed(), 3);
  for (const auto& mesh : {hard::lattice_cube<Real>(5), hard::random_voxels<Real>(rng, 6)}) {
    std::vector<Vec3<Real>> points = hard::vertices_and_midpoints(mesh);
    for (const Triangle& t : mesh.triangles) {
      const auto& [a, b, c] =
          std::tie(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      const auto mixed = [](Real x, Real y, Real z) { return (2 * x + y + z) / 4; };
      points.push_back({mixed(a.x, b.x, c.x), mixed(a.y, b.y, c.y), mixed(a.z, b.z, c.z)});
    }
    const auto scene = Scene<Real>::build(mesh.view());
    for (const Location location : located(scene, points)) {
      ASSERT_EQ(location, Location::OnSurface);
    }
  }
}

TYPED_TEST(Locate, lattice_points_of_a_lattice_cube_are_where_they_are) {
  using Real = TypeParam;
  constexpr int kSize = 6;
  const auto cube = hard::lattice_cube<Real>(kSize);
  const auto scene = Scene<Real>::build(cube.view());
  std::vector<Vec3<Real>> points;
  std::vector<Location> expected;
  for (int n = 0; n < (2 * kSize + 5) * (2 * kSize + 5) * (2 * kSize + 5); ++n) {
    const int i[3] = {n % (2 * kSize + 5) - 2, n / (2 * kSize + 5) % (2 * kSize + 5) - 2,
                      n / ((2 * kSize + 5) * (2 * kSize + 5)) - 2};
    int inside = 0, outside = 0;
    for (const int k : i) {
      inside += k > 0 && k < 2 * kSize;
      outside += k < 0 || k > 2 * kSize;
    }
    const auto half = [](int k) { return static_cast<Real>(k) / 2; };
    points.push_back({half(i[0]), half(i[1]), half(i[2])});
    expected.push_back(outside != 0  ? Location::Outside
                       : inside == 3 ? Location::Inside
                                     : Location::OnSurface);
  }
  EXPECT_EQ(located(scene, points), expected);
}

// On a face of a lattice cube, or a hair off it, and there a hair off the diagonal of a square. The
// vertices are floats, and the points of the scene of doubles are not.
TYPED_TEST(Locate, points_next_to_diagonals_of_a_lattice_cube_are_where_they_are) {
  using Real = TypeParam;
  constexpr int kSize = 6;
  const auto cube = hard::lattice_cube<Real>(kSize);
  const auto scene = Scene<Real>::build(cube.view());
  Rng rng(hard::seed(), 7);
  std::vector<Vec3<Real>> points;
  std::vector<Location> expected;
  for (int n = 0; n < 4000; ++n) {
    const std::size_t axis = rng.below(3);
    const auto part = static_cast<Real>(rng.unit());
    Vec3<Real> p;
    Real& across = hard::component(p, (axis + 1) % 3);
    across = static_cast<Real>(rng.between(0, kSize - 1)) + part;
    hard::component(p, (axis + 2) % 3) =
        hard::nudged(static_cast<Real>(rng.between(0, kSize - 1)) + (rng.coin() ? part : 1 - part),
                     rng.between(-1, 1));
    const int off = rng.between(-1, 1);
    const bool upper = rng.coin();
    hard::component(p, axis) = hard::nudged(static_cast<Real>(upper ? kSize : 0), off);
    points.push_back(p);
    expected.push_back(off == 0             ? Location::OnSurface
                       : (off < 0) == upper ? Location::Inside
                                            : Location::Outside);
  }
  const std::vector<Location> found = located(scene, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(found[i], expected[i]) << show::text(points[i]);
    ASSERT_EQ(scene.locate(points[i]), expected[i]) << show::text(points[i]);
  }
}

// The winding number as a sum of solid angles (Van Oosterom, Strackee 1983), in double: good to
// some 1e-9, so it is nearly an integer unless the point is all but on the surface.
double winding_number(const Mesh<double>& mesh, const Vec3<double>& p) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto seen = [&](std::uint32_t i) {
      const auto& v = mesh.vertices[i];
      return Vec3<double>{v.x - p.x, v.y - p.y, v.z - p.z};
    };
    const auto a = seen(t[0]), b = seen(t[1]), c = seen(t[2]);
    const auto dot = [](const Vec3<double>& x, const Vec3<double>& y) {
      return x.x * y.x + x.y * y.y + x.z * y.z;
    };
    const double volume = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                          a.z * (b.x * c.y - b.y * c.x);
    const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
    sum += std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

// PIERCE_CASES=100000 takes the 10^5 points of the promise, some ten minutes.
TEST(LocateBunny, location_is_the_winding_number_by_solid_angles) {
  const auto mesh = hard::bunny<double>();
  const auto scene = Scene<double>::build(mesh.view());
  Vec3<double> low = mesh.vertices[0], high = low;
  for (const auto& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const auto count = hard::case_count(200);
  std::vector<Vec3<double>> points;
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng(hard::seed(), i);
    const auto between = [&rng](double a, double b) { return a + (b - a) * rng.unit(); };
    const double x = between(low.x, high.x), y = between(low.y, high.y);
    points.push_back({x, y, between(low.z, high.z)});
  }
  const auto locations = located(scene, points);
  std::atomic<std::uint64_t> inside = 0;
  const auto failure = hard::first_failure(count, [&](std::uint64_t i) {
    const double winding = winding_number(mesh, points[i]);
    const double nearest = std::round(winding);
    if (std::fabs(winding - nearest) > 1e-6) return true;
    if ((nearest != 0) != (locations[i] == Location::Inside)) return true;
    inside += nearest != 0 ? 1 : 0;
    return false;
  });
  EXPECT_FALSE(failure) << show::text(points[*failure]) << winding_number(mesh, points[*failure]);
  if (hard::enough_cases(200)) {
    EXPECT_GT(inside, count / 10);
    EXPECT_LT(inside, count / 2);
  }
}

}  // namespace
}  // namespace pierce
