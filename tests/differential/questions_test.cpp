// SPDX-License-Identifier: Apache-2.0
//
// Questions of a mesh: nearest triangles, what touches a segment or a box, self-intersections,
// measures; against oracles over rational numbers that look at every triangle.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "pierce/measure.h"
#include "pierce/scene.h"
#include "support/hard_points.h"
#include "support/meshes.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

using Rational = std::array<mpq_class, 3>;
using Polygon = std::vector<Rational>;

template <class Real>
Rational rational(const Vec3<Real>& p) {
  return {mpq_class(double(p.x)), mpq_class(double(p.y)), mpq_class(double(p.z))};
}

template <class Real>
Polygon polygon(const Mesh<Real>& mesh, const Triangle& t) {
  return {rational(mesh.vertices[t[0]]), rational(mesh.vertices[t[1]]),
          rational(mesh.vertices[t[2]])};
}

// What of a convex polygon (or segment, or point) lies where f, linear, is not negative.
Polygon clipped(const Polygon& p, const auto& f) {
  Polygon kept;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Rational& a = p[i];
    const Rational& b = p[(i + 1) % p.size()];
    const mpq_class at_a = f(a), at_b = f(b);
    if (at_a >= 0) kept.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) {
      const mpq_class k = at_a / (at_a - at_b);
      kept.push_back(
          {a[0] + k * (b[0] - a[0]), a[1] + k * (b[1] - a[1]), a[2] + k * (b[2] - a[2])});
    }
  }
  return kept;
}

Rational minus(const Rational& p, const Rational& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
mpq_class dot(const Rational& p, const Rational& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
Rational cross(const Rational& p, const Rational& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

// What of p lies in the triangle t, which has area.
Polygon within_triangle(Polygon p, const Polygon& t) {
  const Rational n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  for (const int sign : {1, -1}) {
    p = clipped(p, [&](const Rational& x) { return mpq_class(sign * dot(n, minus(x, t[0]))); });
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational inward = cross(n, minus(t[(i + 1) % 3], t[i]));
    p = clipped(p, [&](const Rational& x) { return dot(inward, minus(x, t[i])); });
  }
  return p;
}

bool has_area(const Polygon& t) {
  const Rational n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  return n[0] != 0 || n[1] != 0 || n[2] != 0;
}

bool touches_box(Polygon p, const Rational& low, const Rational& high) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    p = clipped(p, [&](const Rational& x) { return mpq_class(x[axis] - low[axis]); });
    p = clipped(p, [&](const Rational& x) { return mpq_class(high[axis] - x[axis]); });
  }
  return !p.empty();
}

// Whether all points of the polygon are corners of both, or on the edge that both have.
bool is_overlap(const Polygon& p, const Polygon& q) {
  Polygon common;
  for (const Rational& x : p) {
    if (std::find(q.begin(), q.end(), x) != q.end()) common.push_back(x);
  }
  if (common.size() == 3) return true;
  for (const Rational& x : within_triangle(p, q)) {
    if (common.empty()) return true;
    if (common.size() == 1 && x != common[0]) return true;
    if (common.size() == 1) continue;
    const Rational off = cross(minus(x, common[0]), minus(common[1], common[0]));
    if (off[0] != 0 || off[1] != 0 || off[2] != 0) return true;
  }
  return false;
}

template <class Real>
class Questions : public testing::Test {
 public:
  static std::vector<std::pair<std::string, Mesh<Real>>> meshes(Rng& rng) {
    return {{"sphere", hard::icosphere<Real>(1)},
            {"cube", hard::lattice_cube<Real>(2)},
            {"soup", hard::soup<Real>(rng, Style::Unit, 40)},
            {"integers", hard::soup<Real>(rng, Style::SmallInteger, 60)},
            {"lattice", hard::soup<Real>(rng, Style::Lattice, 60)},
            {"needles", hard::needles<Real>(rng, 30)},
            {"copies", hard::copies(rng, hard::lattice_cube<Real>(1), 3)},
            {"mixed", hard::soup<Real>(rng, Style::Mixed, 20)},
            {"tiny", hard::soup<Real>(rng, Style::Denormal, 20)}};
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Questions, Reals);

TYPED_TEST(Questions, nearest_triangles_are_in_exact_order) {
  using Real = TypeParam;
  Rng rng(18, 10);
  for (const auto& [name, mesh] : this->meshes(rng)) {
    const auto scene = Scene<Real>::build(mesh.view());
    for (int i = 0; i < 20; ++i) {
      const auto p = hard::hard_point(rng, mesh, Style::Lattice);
      std::vector<NearestPoint<Real>> all, first, near;
      scene.nearest_triangles(p, kUnlimited, all);
      ASSERT_EQ(all.size(), mesh.triangles.size()) << name;
      ASSERT_EQ(all[0], scene.nearest_point(p)) << name << show::text(p);
      for (std::size_t k = 0; k < all.size(); ++k) {
        const std::vector<Triangle> one{mesh.triangles[all[k].triangle]};
        auto alone = *Scene<Real>::build(MeshView<Real>{mesh.vertices, one}).nearest_point(p);
        alone.triangle = all[k].triangle;
        ASSERT_EQ(alone, all[k]) << name << show::text(p);
        if (k == 0) continue;
        // Of both alone, the nearer one comes first; if none is, the smaller number.
        std::vector<Triangle> two{mesh.triangles[all[k - 1].triangle], one[0]};
        const bool swapped = all[k - 1].triangle > all[k].triangle;
        if (swapped) std::swap(two[0], two[1]);
        const auto nearer =
            *Scene<Real>::build(MeshView<Real>{mesh.vertices, two}).nearest_point(p);
        ASSERT_EQ(nearer.triangle, swapped ? 1U : 0U) << name << show::text(p);
      }
      for (std::size_t most = 0; most <= 8; ++most) {
        scene.nearest_triangles(p, most, first);
        const auto expected = static_cast<std::ptrdiff_t>(std::min(most, all.size()));
        ASSERT_EQ(first, std::vector(all.begin(), all.begin() + expected)) << name << most;
      }
      const Real radius = all[rng.below(all.size())].distance;
      scene.nearest_triangles(p, kUnlimited, near, radius);
      ASSERT_LE(near.size(), all.size());
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (k < near.size()) {
          ASSERT_EQ(near[k], all[k]) << name;
          ASSERT_LE(near[k].distance, radius);
        } else {
          ASSERT_GE(all[k].distance, radius) << name;
        }
      }
    }
  }
}

TYPED_TEST(Questions, what_touches_a_segment_or_a_box_is_what_is_left_of_it_when_it_is_clipped) {
  using Real = TypeParam;
  Rng rng(18, 11);
  for (const auto& [name, mesh] : this->meshes(rng)) {
    const auto scene = Scene<Real>::build(mesh.view());
    for (int i = 0; i < 25; ++i) {
      auto p = hard::hard_point(rng, mesh, Style::Lattice);
      auto q = rng.one_in(8) ? p : hard::hard_point(rng, mesh, Style::Lattice);
      std::vector<TriangleRef> segment, box, segment_truth, box_truth;
      scene.touching_segment(p, q, segment);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (rng.one_in(6)) hard::component(q, axis) = hard::component(p, axis);
      }
      const Vec3<Real> r = q;
      scene.touching_segment(p, r, segment);
      const Vec3<Real> low{std::min(p.x, r.x), std::min(p.y, r.y), std::min(p.z, r.z)};
      const Vec3<Real> high{std::max(p.x, r.x), std::max(p.y, r.y), std::max(p.z, r.z)};
      scene.touching_box(low, high, box);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Polygon corners = polygon(mesh, mesh.triangles[t]);
        if (touches_box(corners, rational(low), rational(high))) box_truth.push_back({0, t});
        if (!has_area(corners)) {
          std::erase(segment, TriangleRef{0, t});  // looked at below
          continue;
        }
        if (!within_triangle({rational(p), rational(r)}, corners).empty()) {
          segment_truth.push_back({0, t});
        }
      }
      ASSERT_EQ(box, box_truth) << name << show::text(low) << show::text(high);
      ASSERT_EQ(segment, segment_truth) << name << show::text(p) << show::text(r);
      if (high != low) continue;
      scene.touching_segment(p, r, segment);  // a point, also on what has no area
      ASSERT_EQ(segment, box) << name << show::text(p);
    }
  }
}

TYPED_TEST(Questions, self_intersections_are_what_two_triangles_share_beside_corners_and_edges) {
  Rng rng(18, 12);
  for (const auto& [name, mesh] : this->meshes(rng)) {
    std::vector<TrianglePair> truth;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Polygon p = polygon(mesh, mesh.triangles[i]);
      if (!has_area(p)) continue;
      for (std::uint32_t j = i + 1; j < mesh.triangles.size(); ++j) {
        const Polygon q = polygon(mesh, mesh.triangles[j]);
        if (has_area(q) && is_overlap(p, q)) truth.push_back({i, j});
      }
    }
    EXPECT_EQ(self_intersections(mesh.view()), truth) << name;
    EXPECT_EQ(self_intersections(mesh.view(), {.threads = 1}), truth) << name;
    if (name == "sphere" || name == "cube") {
      EXPECT_TRUE(truth.empty()) << name;
    }
  }
}

// Whether no neighbour is nearer.
bool is_nearest(double found, const mpq_class& truth) {
  const mpq_class off = abs(mpq_class(found) - truth);
  return off <= abs(mpq_class(std::nextafter(found, -1e308)) - truth) &&
         off <= abs(mpq_class(std::nextafter(found, 1e308)) - truth);
}

TYPED_TEST(Questions, measures_are_exact) {
  constexpr mp_bitcnt_t kBits = 4096;
  Rng rng(18, 13);
  for (const auto& [name, mesh] : this->meshes(rng)) {
    mpq_class six_volumes = 0;
    mpf_class two_areas(0, kBits);
    for (const Triangle& t : mesh.triangles) {
      const Polygon p = polygon(mesh, t);
      six_volumes += dot(p[0], cross(p[1], p[2]));
      const Rational n = cross(minus(p[1], p[0]), minus(p[2], p[0]));
      two_areas += sqrt(mpf_class(dot(n, n), kBits));
    }
    const MeshMeasures found = measure(mesh.view());
    if (std::isfinite(found.volume)) {
      EXPECT_TRUE(is_nearest(found.volume, mpq_class(six_volumes / 6))) << name;
    }
    if (std::isfinite(found.area)) {
      EXPECT_TRUE(is_nearest(found.area, mpq_class(mpf_class(two_areas / 2)))) << name;
    }
  }
}

TYPED_TEST(Questions, compact_trees_say_the_same_and_trees_that_instances_share_are_refused) {
  using Real = TypeParam;
  const auto mesh = hard::torus<Real>(12, 8);
  const auto full = Scene<Real>::build(mesh.view());
  const auto compact = Scene<Real>::build(mesh.view(), {.quality = Quality::Compact});
  const Vec3<Real> p{Real(0.5), 0, 0}, q{3, 1, Real(0.25)};
  std::vector<NearestPoint<Real>> near, same_near;
  std::vector<TriangleRef> touched, same_touched;
  full.nearest_triangles(p, 9, near);
  compact.nearest_triangles(p, 9, same_near);
  EXPECT_EQ(near, same_near);
  full.touching_segment(p, q, touched);
  compact.touching_segment(p, q, same_touched);
  EXPECT_EQ(touched, same_touched);
  EXPECT_FALSE(touched.empty());
  EXPECT_EQ(full.winding_number(p), compact.winding_number(p));

  Instance<Real> here{mesh.view()}, there{mesh.view()};
  there.transform.rows[0][3] = 16;
  const auto shared = Scene<Real>::build(std::vector{here, there}, {.flatten_limit = 0});
  const auto refusal = [](const auto& ask) -> std::string {
    try {
      ask();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      return error.what();
    }
    return "none";
  };
  const auto text = [](const std::string& what) {
    return "instances that share their meshes' trees are not for " + what +
           "; build the scene with a larger flatten_limit";
  };
  EXPECT_EQ(refusal([&] { (void)shared.winding_number(p); }), text("winding numbers"));
  EXPECT_EQ(refusal([&] { (void)shared.locate(p, {.rule = InsideRule::Winding}); }),
            text("the rule Winding"));
  full.touching_box(p, q, touched);
  shared.touching_box(p, q, same_touched);
  EXPECT_EQ(touched, same_touched);
  EXPECT_FALSE(touched.empty());
}

// Triangles with one fine edge, far beyond what the bits of a product bridge.
TYPED_TEST(Questions, areas_of_any_magnitudes_are_rounded_once) {
  using Real = TypeParam;
  constexpr int kFinest = std::is_same_v<Real, float> ? 110 : 900;
  for (int k = 20; k <= kFinest; k += k < 200 ? 15 : 90) {
    Rng rng(18, 14 + static_cast<std::uint64_t>(k));
    for (int i = 0; i < 10; ++i) {
      const auto coarse = [&] { return static_cast<Real>(rng.symmetric()); };
      const auto fine = [&] {
        return static_cast<Real>(std::ldexp(rng.between(-1000000, 1000000), -20 - k));
      };
      Mesh<Real> mesh;
      mesh.vertices = {{coarse(), coarse(), coarse()},
                       {fine(), fine(), fine()},
                       {fine(), fine(), fine()},
                       {fine(), 0, fine()}};
      mesh.triangles = {{0, 1, 2}};
      if (i % 2 == 0) mesh.triangles.push_back({1, 2, 3});
      mpf_class twice(0, 8192);
      for (const Triangle& t : mesh.triangles) {
        const Polygon p = polygon(mesh, t);
        const Rational n = cross(minus(p[1], p[0]), minus(p[2], p[0]));
        twice += sqrt(mpf_class(dot(n, n), 8192));
      }
      EXPECT_TRUE(is_nearest(measure(mesh.view()).area, mpq_class(mpf_class(twice / 2)))) << k;
    }
  }
}

TYPED_TEST(Questions, known_measures) {
  using Real = TypeParam;
  const auto torus = measure(hard::torus<Real>(12, 8).view());
  EXPECT_EQ(torus.euler, 0);
  EXPECT_EQ(torus.components, 1U);
  EXPECT_EQ(torus.edges, 3U * 96);
  EXPECT_TRUE(torus.consistent && torus.orientable);
  const auto cube = measure(hard::lattice_cube<Real>(2).view(), SameVertex::Position);
  EXPECT_EQ(cube.euler, 2);
  EXPECT_EQ(cube.volume, 8);
  EXPECT_EQ(cube.area, 24);
  Mesh<Real> strip;  // a Moebius strip of five squares
  for (int i = 0; i < 5; ++i) {
    const double turn = 2 * std::numbers::pi * i / 5;
    for (const double side : {-0.5, 0.5}) {
      const double r = 2 + side * std::cos(turn / 2);
      strip.add(
          {Real(r * std::cos(turn)), Real(r * std::sin(turn)), Real(side * std::sin(turn / 2))});
    }
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, c = i < 4 ? a + 2 : 1, d = i < 4 ? a + 3 : 0;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  const auto moebius = measure(strip.view());
  EXPECT_FALSE(moebius.orientable);
  EXPECT_FALSE(moebius.consistent);
  EXPECT_EQ(moebius.euler, 0);
  strip.triangles.pop_back();
  std::swap(strip.triangles[2][0], strip.triangles[2][1]);
  const auto open = measure(strip.view());
  EXPECT_TRUE(open.orientable);
  EXPECT_FALSE(open.consistent);
  const auto empty = measure(MeshView<Real>{});
  EXPECT_EQ(empty.volume, 0);
  EXPECT_EQ(empty.components, 0U);
}

}  // namespace
}  // namespace pierce
