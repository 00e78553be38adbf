// SPDX-License-Identifier: Apache-2.0
//
// The traversal to the nearest triangle never loses it: against every triangle in turn, decided by
// the same exact predicate. Triangles that are all but equally far away, on all sides of the point,
// of all shapes and sizes, and points from on the surface to far outside float's reach.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "pierce/scene.h"
#include "predicate/nearest.h"
#include "support/hard_points.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
std::uint32_t nearest_by_brute_force(const Mesh<Real>& mesh, const Vec3<Real>& point) {
  const Vec3<double> p = predicate::to_double(point);
  predicate::LadderCounts counts;
  std::optional<predicate::NearTriangle> best;
  std::uint32_t number = kNone;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const predicate::TriangleD triangle{predicate::to_double(mesh.vertices[t[0]]),
                                        predicate::to_double(mesh.vertices[t[1]]),
                                        predicate::to_double(mesh.vertices[t[2]])};
    const auto near = predicate::decide_near(p, triangle, counts);
    if (best && predicate::decide_nearer(p, near, *best, counts) >= 0) continue;
    best = near;
    number = i;
  }
  return number;
}

Vec3<double> unit_vector(Rng& rng) {
  for (;;) {
    const Vec3<double> v{rng.symmetric(), rng.symmetric(), rng.symmetric()};
    const double size = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    if (size > 0.1 && size < 1) return {v.x / size, v.y / size, v.z / size};
  }
}

// Triangles that touch a ball around the point, or all but: with a face, an edge or a corner.
template <class Real>
Mesh<Real> around(Rng& rng, const Vec3<double>& point, double radius, std::uint32_t count) {
  Mesh<Real> mesh;
  // Of doubles, in half of the cases, so little that even double does not tell.
  const bool fine = std::is_same_v<Real, double> && rng.coin();
  const double off = std::ldexp(radius, -(fine ? rng.between(45, 56) : rng.between(20, 27)));
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3<double> n = unit_vector(rng);
    const Vec3<double> e = unit_vector(rng), f = unit_vector(rng);
    const double size = std::ldexp(radius, -rng.between(fine ? -8 : -1, 12));
    const double needle = rng.one_in(3) ? 0x1p-15 : 1;
    const double at = radius + off * rng.symmetric();
    const auto tangent = [&](const Vec3<double>& v, double k) {  // v without what goes along n
      const double along = v.x * n.x + v.y * n.y + v.z * n.z;
      return Vec3<double>{k * (v.x - along * n.x), k * (v.y - along * n.y),
                          k * (v.z - along * n.z)};
    };
    const Vec3<double> s = tangent(e, size), t = tangent(f, size * needle);
    const auto corner = [&](double x, double y) {
      const auto number = [&](double p, double m, double a, double b) {
        return static_cast<Real>(p + at * m + x * a + y * b);
      };
      return mesh.add({number(point.x, n.x, s.x, t.x), number(point.y, n.y, s.y, t.y),
                       number(point.z, n.z, s.z, t.z)});
    };
    const std::uint32_t a = corner(rng.unit() - 0.5, rng.unit() - 0.5);
    const std::uint32_t b = corner(rng.unit(), -rng.unit());
    mesh.triangles.push_back({a, b, corner(-rng.unit(), rng.unit())});
  }
  return mesh;
}

template <class Real>
class NearestBounds : public testing::Test {
 public:
  static bool is_lost(const Mesh<Real>& mesh, const Scene<Real>& scene, const Vec3<Real>& point) {
    const std::uint32_t expected = nearest_by_brute_force(mesh, point);
    const auto found = scene.nearest_point(point);
    if (found && found->triangle == expected) return false;
    ADD_FAILURE() << show::text(point) << ": triangle " << expected << " was lost for "
                  << (found ? found->triangle : kNone);
    return true;
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(NearestBounds, Reals);

TYPED_TEST(NearestBounds, of_triangles_all_but_equally_far_none_is_lost) {
  using Real = TypeParam;
  const auto fails = [](std::uint64_t i) {
    Rng rng(hard::seed() + 540, i);
    const Vec3<Real> point = hard::vec<Real>(rng, Style::Unit);
    const double radius = std::ldexp(1 + rng.unit(), rng.between(-12, 3));
    auto mesh = around<Real>(rng, predicate::to_double(point), radius, 24);
    if (rng.coin()) {  // something far away, so that the point is not in the middle of the scene
      const Vec3<double> away = unit_vector(rng);
      const double far = std::ldexp(radius, rng.between(1, 12));
      const auto place = [&](Real x, double d) {
        return static_cast<Real>(static_cast<double>(x) + far * d);
      };
      const std::uint32_t at =
          mesh.add({place(point.x, away.x), place(point.y, away.y), place(point.z, away.z)});
      mesh.triangles.push_back({at, at, at});
    }
    const auto scene = Scene<Real>::build(mesh.view(), {.work = {.threads = 1}});
    return NearestBounds<Real>::is_lost(mesh, scene, point);
  };
  EXPECT_EQ(hard::first_failure(hard::case_count(4000), fails), std::nullopt);
}

// The mesh is a small patch of a huge ball: float cannot tell the distances any more.
TYPED_TEST(NearestBounds, far_points_lose_nothing) {
  using Real = TypeParam;
  const auto fails = [](std::uint64_t i) {
    Rng rng(hard::seed() + 541, i);
    const Mesh<Real> mesh = hard::soup<Real>(rng, Style::Unit, 40);
    const auto scene = Scene<Real>::build(mesh.view(), {.work = {.threads = 1}});
    for (int k = 0; k < 8; ++k) {
      Vec3<Real> point = hard::vec<Real>(rng, Style::Unit);
      const int away = rng.between(0, 70);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        hard::component(point, axis) = std::ldexp(hard::component(point, axis), away);
      }
      if (NearestBounds<Real>::is_lost(mesh, scene, point)) return true;
    }
    return false;
  };
  EXPECT_EQ(hard::first_failure(hard::case_count(400), fails), std::nullopt);
}

TYPED_TEST(NearestBounds, large_soups_lose_nothing) {
  using Real = TypeParam;
  const auto fails = [](std::uint64_t i) {
    Rng rng(hard::seed() + 542, i);
    const Style style = rng.pick(hard::kTameStyles);
    const Mesh<Real> mesh =
        rng.coin() ? hard::soup<Real>(rng, style, 400) : hard::needles<Real>(rng, 400);
    const auto scene = Scene<Real>::build(mesh.view(), {.work = {.threads = 1}});
    for (int k = 0; k < 40; ++k) {
      if (NearestBounds<Real>::is_lost(mesh, scene, hard::hard_point(rng, mesh, style)))
        return true;
    }
    return false;
  };
  EXPECT_EQ(hard::first_failure(hard::case_count(30), fails), std::nullopt);
}

}  // namespace
}  // namespace pierce
