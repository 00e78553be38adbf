// SPDX-License-Identifier: Apache-2.0
//
// Winding numbers against the sum of all solid angles in 448 bits: no number outside its bound, and
// the rule Winding as that sum says.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pierce/scene.h"
#include "pierce/voxelise.h"
#include "support/brute_force.h"
#include "support/hard_points.h"
#include "support/meshes.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <unsigned Bits>
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<Bits, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

// Exact but for roots, quotients and angles if coordinates have few enough bits.
template <class T, class Real>
T true_winding(const Mesh<Real>& mesh, const Vec3<Real>& point) {
  struct Vector {
    T x, y, z;
  };
  const auto from_point = [&](std::uint32_t vertex) {
    const Vec3<Real>& p = mesh.vertices[vertex];
    return Vector{T(p.x) - T(point.x), T(p.y) - T(point.y), T(p.z) - T(point.z)};
  };
  const auto dot = [](const Vector& p, const Vector& q) -> T {
    return p.x * q.x + p.y * q.y + p.z * q.z;
  };
  T sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector a = from_point(t[0]), b = from_point(t[1]), c = from_point(t[2]);
    const T up = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                 a.z * (b.x * c.y - b.y * c.x);
    if (up == 0) continue;
    const T la = sqrt(dot(a, a)), lb = sqrt(dot(b, b)), lc = sqrt(dot(c, c));
    sum += atan2(up, T(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb));
  }
  return sum / (2 * boost::math::constants::pi<T>());
}

template <class Real>
Mesh<Real> with_holes(Rng& rng, Mesh<Real> mesh, int holes) {
  for (int i = 0; i < holes && !mesh.triangles.empty(); ++i) {
    const std::uint64_t at = rng.below(mesh.triangles.size());
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(at));
  }
  return mesh;
}

// Some walls of a lattice cube away: holes in planes, whose points are at exactly 1/2.
template <class Real>
Mesh<Real> open_box(int n, std::uint32_t walls) {
  Mesh<Real> mesh = hard::lattice_cube<Real>(n);
  for (std::uint32_t axis = 0; axis < walls; ++axis) {
    Real least = mesh.vertices[0].x;
    for (auto& v : mesh.vertices) least = std::min(least, hard::component(v, axis));
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
        return hard::component(mesh.vertices[v], axis) == least;
      });
    });
  }
  return mesh;
}

template <class Real>
std::vector<std::pair<std::string, Mesh<Real>>> meshes(Rng& rng) {
  auto flipped = hard::icosphere<Real>(1);
  for (std::size_t i = 0; i < flipped.triangles.size(); i += 3) {
    std::swap(flipped.triangles[i][0], flipped.triangles[i][1]);
  }
  // A cube one of whose walls has a vertex more than its neighbours, and so a T-junction.
  Mesh<Real> split = hard::lattice_cube<Real>(1);
  const Triangle t = split.triangles[0];
  const auto middle = [](Real p, Real q) { return (p + q) / 2; };
  const Vec3<Real> p = split.vertices[t[0]], q = split.vertices[t[1]];
  split.vertices.push_back({middle(p.x, q.x), middle(p.y, q.y), middle(p.z, q.z)});
  const auto added = static_cast<std::uint32_t>(split.vertices.size() - 1);
  split.triangles[0] = {added, t[1], t[2]};
  split.triangles.push_back({t[0], added, t[2]});
  return {{"closed sphere", hard::icosphere<Real>(1)},
          {"sphere with holes", with_holes(rng, hard::icosphere<Real>(1), 20)},
          {"torus with holes", with_holes(rng, hard::torus<Real>(9, 6), 15)},
          {"voxels with holes", with_holes(rng, hard::random_voxels<Real>(rng, 3), 25)},
          {"open box", open_box<Real>(2, 1)},
          {"wider open box", open_box<Real>(3, 2)},
          {"terrain", hard::terrain<Real>(rng, 8)},
          {"flipped", flipped},
          {"T-junction", split},
          {"far from the origin", hard::soup<Real>(rng, Style::Georeferenced, 30)},
          {"soup", hard::soup<Real>(rng, Style::Unit, 60)},
          {"lattice soup", hard::soup<Real>(rng, Style::Lattice, 60)},
          {"needles", hard::needles<Real>(rng, 40)},
          {"copies", hard::copies(rng, with_holes(rng, hard::icosphere<Real>(0), 3), 2)},
          {"one", with_holes(rng, hard::icosphere<Real>(0), 19)},
          {"none", with_holes(rng, hard::icosphere<Real>(0), 20)}};
}

template <class Real>
bool is_moderate(const Vec3<Real>& p) {
  const auto fits = [](Real x) {
    const double size = std::fabs(static_cast<double>(x));
    return size == 0 || (size > 0x1p-90 && size < 0x1p70);
  };
  return fits(p.x) && fits(p.y) && fits(p.z);
}

template <class Real>
class Winding : public testing::Test {
 public:
  template <class T>
  static void expect_right(const std::string& name, const Mesh<Real>& mesh,
                           const std::vector<Vec3<Real>>& points) {
    const auto scene = Scene<Real>::build(mesh.view());
    const oracle::BruteForce<Real> on(mesh.view());
    std::vector<WindingNumber> loose(points.size()), tight(points.size());
    std::vector<Location> locations(points.size());
    scene.winding_numbers(points, loose, {.tolerance = 1e-3});
    scene.winding_numbers(points, tight);
    scene.locate(points, locations, {.rule = InsideRule::Winding});
    const T half = T(1) / 2;
    const T blur = ldexp(T(1), -300);  // of the sum in T itself
    for (std::size_t i = 0; i < points.size(); ++i) {
      const T truth = true_winding<T>(mesh, points[i]);
      for (const WindingNumber& found : {loose[i], tight[i], scene.winding_number(points[i])}) {
        ASSERT_LE(T(abs(T(found.value) - truth)), T(found.error) + blur)
            << name << " " << show::text(points[i]) << found.value << " +- " << found.error;
      }
      EXPECT_LE(tight[i].error, 1e-6) << name << show::text(points[i]);
      EXPECT_EQ(tight[i], scene.winding_number(points[i])) << name << show::text(points[i]);
      Location expected = truth > half + blur ? Location::Inside : Location::Outside;
      if (on.on_surface(points[i])) expected = Location::OnSurface;
      ASSERT_EQ(locations[i], expected) << name << show::text(points[i]) << double(truth);
      ASSERT_EQ(scene.locate(points[i], {.rule = InsideRule::Winding}), expected) << name;
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Winding, Reals);

TYPED_TEST(Winding, no_number_is_outside_its_bound) {
  using Real = TypeParam;
  Rng rng(18, 1);
  for (const auto& [name, mesh] : meshes<Real>(rng)) {
    std::vector<Vec3<Real>> points;
    while (points.size() < 15) {
      const auto p = mesh.triangles.empty() ? hard::vec<Real>(rng, Style::Lattice)
                                            : hard::hard_point(rng, mesh, Style::Unit);
      if (is_moderate(p)) points.push_back(p);
    }
    this->template expect_right<Wide<448>>(name, mesh, points);
  }
}

TYPED_TEST(Winding, every_number_of_threads_gives_the_same_bits) {
  using Real = TypeParam;
  Rng rng(18, 2);
  const auto mesh = hard::soup<Real>(rng, Style::Unit, 3000);  // deep enough for multipoles
  const auto scene = Scene<Real>::build(mesh.view());
  std::vector<Vec3<Real>> points(500);
  for (auto& p : points) p = hard::hard_point(rng, mesh, Style::Unit);
  std::vector<WindingNumber> all(points.size()), one(points.size());
  scene.winding_numbers(points, all, {.tolerance = 1e-4});
  scene.winding_numbers(points, one, {.tolerance = 1e-4, .work = {.threads = 1}});
  EXPECT_EQ(all, one);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(all[i], scene.winding_number(points[i], {.tolerance = 1e-4}));
    const WindingNumber exact = scene.winding_number(points[i], {.tolerance = 0});
    EXPECT_LT(exact.error, 1e-9);
    ASSERT_LE(std::fabs(exact.value - all[i].value), exact.error + all[i].error);
  }
}

TYPED_TEST(Winding, closed_surfaces_have_whole_numbers) {
  using Real = TypeParam;
  Rng rng(18, 3);
  const auto mesh = hard::torus<Real>(24, 12);
  const auto scene = Scene<Real>::build(mesh.view());
  for (int i = 0; i < 200; ++i) {
    const auto p = hard::vec<Real>(rng, Style::Unit);
    const WindingNumber found = scene.winding_number(p);
    const bool inside = scene.locate(p) == Location::Inside;
    ASSERT_EQ(found, (WindingNumber{inside ? 1.0 : 0.0, 0.0}));
  }
}

TYPED_TEST(Winding, all_questions_of_inside_take_the_rule_and_refit_renews_it) {
  using Real = TypeParam;
  Rng rng(18, 4);
  auto mesh = with_holes(rng, hard::icosphere<Real>(2), 30);
  auto scene = Scene<Real>::build(mesh.view());
  const LocateOptions options{.rule = InsideRule::Winding};
  EXPECT_THROW((void)scene.locate({0, 0, 0}), Error);
  const Grid<Real> grid{{-1, -1, -1}, {Real(0.25), Real(0.25), Real(0.25)}, {8, 8, 8}};
  std::vector<Location> cells(grid.cells());
  for (int round = 0; round < 2; ++round) {
    voxelise(scene, grid, std::span(cells), options);
    const auto anew = Scene<Real>::build(mesh.view());
    std::size_t inside = 0;
    for (std::uint32_t i = 0; i < 512; ++i) {
      const auto centre = grid.centre(i / 64, i / 8 % 8, i % 8);
      ASSERT_EQ(cells[i], anew.locate(centre, options));
      ASSERT_EQ(scene.signed_distance(centre, options) < 0, cells[i] == Location::Inside);
      inside += cells[i] == Location::Inside;
    }
    EXPECT_GT(inside, round == 0 ? 150U : 10U);
    for (auto& v : mesh.vertices) v = {v.x / 2, v.y / 2, v.z};
    scene.refit();
  }
}

TYPED_TEST(Winding, hard_inputs_are_refused_or_answered) {
  using Real = TypeParam;
  const auto mesh = open_box<Real>(1, 1);
  const auto scene = Scene<Real>::build(mesh.view());
  constexpr Real kHuge = std::numeric_limits<Real>::max(),
                 kLeast = std::numeric_limits<Real>::denorm_min();
  EXPECT_THROW((void)scene.winding_number({std::numeric_limits<Real>::quiet_NaN(), 0, 0}), Error);
  EXPECT_THROW((void)scene.winding_number({0, 0, 0}, {.tolerance = -1}), Error);
  EXPECT_THROW((void)scene.winding_number({0, 0, 0}, {.tolerance = std::nan("")}), Error);
  EXPECT_LT(scene.winding_number({kHuge, -kHuge, kHuge}).error, 1e-20);
  for (const Real x : {kLeast, -kLeast, Real(0), -Real(0)}) {  // a hair beside the hole's plane
    const WindingNumber found = scene.winding_number({x, Real(0.5), Real(0.5)});
    EXPECT_LE(found.error, 1e-6);
    EXPECT_NEAR(found.value, 0.5, 1e-6);
    EXPECT_EQ(scene.locate({x, Real(0.5), Real(0.5)}, {.rule = InsideRule::Winding}),
              x > 0 ? Location::Inside : Location::Outside);
  }
}

// What is seen of a triangle is half a turn, one way or the other; how far off its plane the point
// lies is nothing beside its size, even for double.
TEST(WindingOfDoubles, a_side_is_known_however_near_the_plane) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const std::vector<Vec3<double>> corners{
      {kMost, 1, 1.0 / 3}, {1.0 / 3, -1, -kMost}, {-kMost, 1, 1}};
  const Vec3<double> point{-5.992310449541054e+307, 0.3333333333333334, -5.992310449541052e+307};
  const auto number = [&](const Triangle& t) {
    const std::vector<Triangle> one{t};
    return Scene<double>::build(MeshView<double>{corners, one}).winding_number(point);
  };
  const WindingNumber there = number({0, 1, 2}), back = number({0, 2, 1});
  EXPECT_NEAR(there.value, -0.5, there.error);
  EXPECT_NEAR(back.value, 0.5, back.error);
  EXPECT_LT(there.error, 1e-6);
}

}  // namespace
}  // namespace pierce
