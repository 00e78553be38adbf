// SPDX-License-Identifier: Apache-2.0
//
// Crossings against the definition over rationals, single and in batches; and what they are for:
// from inside a closed mesh every ray leaves it, through vertices and edges as well as faces.
#include <gtest/gtest.h>

#include <vector>

#include "pierce/scene.h"
#include "support/brute_force.h"
#include "support/closed_meshes.h"
#include "support/hard_rays.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class CrossingsAgainstOracle : public testing::Test {
 public:
  static void expect_exact(Rng& rng, const std::string& name, const Mesh<Real>& mesh, Style style,
                           int count, const BuildOptions& options = {}) {
    const auto scene = Scene<Real>::build(mesh.view(), options);
    const oracle::BruteForce<Real> truth(mesh.view());
    std::vector<Ray<Real>> rays;
    for (int i = 0; i < count; ++i) rays.push_back(hard::aimed_ray(rng, mesh, style).ray);
    std::vector<Crossings> batch(rays.size());
    scene.crossings(rays, batch);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Crossings expected = truth.crossings(rays[i]);
      const Crossings found = scene.crossings(rays[i]);
      ASSERT_EQ(found, batch[i]) << name << " " << show::text(rays[i]);
      ASSERT_EQ(found.count, expected.count) << name << " " << show::text(rays[i]);
      ASSERT_EQ(found.signed_count, expected.signed_count) << name << " " << show::text(rays[i]);
      ASSERT_EQ(found.origin_on_surface, expected.origin_on_surface)
          << name << " " << show::text(rays[i]);
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(CrossingsAgainstOracle, Reals);

TYPED_TEST(CrossingsAgainstOracle, soups_of_every_style_are_counted_exactly) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(60); ++i) {
    Rng rng(hard::seed(), i);
    const Style style = hard::kAllStyles[i % hard::kAllStyles.size()];
    Mesh<Real> mesh = hard::soup<Real>(rng, style, static_cast<std::uint32_t>(1 + rng.below(40)));
    if (rng.one_in(3)) mesh = hard::copies(rng, mesh, 1 + rng.between(1, 3));
    const BuildOptions options{.quality = static_cast<Quality>(rng.below(4))};
    this->expect_exact(rng, "soup " + std::to_string(i), mesh, style, 12, options);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TYPED_TEST(CrossingsAgainstOracle, closed_meshes_are_counted_exactly) {
  for (const auto& [name, mesh] : hard::small_closed_meshes<TypeParam>()) {
    Rng rng(hard::seed(), 9);
    const bool lattice = name == "lattice cube" || name == "voxels";
    const Style style = lattice ? Style::SmallInteger : Style::Unit;
    this->expect_exact(rng, name, mesh, style, 80);
    this->expect_exact(rng, name, mesh, style, 20, {.quality = Quality::Compact});
  }
}

// The winding number of a point inside is 1 whichever way its rays go; of one outside 0.
TYPED_TEST(CrossingsAgainstOracle, rays_through_vertices_and_edges_leave_closed_meshes_once_more) {
  using Real = TypeParam;
  for (const auto& closed : hard::small_closed_meshes<Real>()) {
    const auto& name = closed.name;
    const auto& mesh = closed.mesh;
    Rng rng(hard::seed(), 4);
    const auto scene = Scene<Real>::build(mesh.view());
    const auto targets = hard::vertices_and_midpoints(mesh);
    const auto inside = hard::points_inside(rng, mesh, 3);
    const std::vector<Vec3<Real>> outside{{16, 0, 0}, {-3, 17, 1}, {0, 0, -64}};
    const auto expect_winding = [&](const Vec3<Real>& o, int winding) {
      for (const auto& p : targets) {
        const Ray<Real> ray{o, {p.x - o.x, p.y - o.y, p.z - o.z}};
        const Crossings crossings = scene.crossings(ray);
        ASSERT_EQ(crossings.signed_count, winding) << name << " " << show::text(ray);
        ASSERT_EQ(static_cast<int>(crossings.count % 2), winding) << name << " " << show::text(ray);
        ASSERT_FALSE(crossings.origin_on_surface) << name << " " << show::text(ray);
      }
    };
    for (const auto& o : inside) expect_winding(o, 1);
    for (const auto& o : outside) expect_winding(o, 0);
  }
}

TYPED_TEST(CrossingsAgainstOracle, every_vertex_is_on_the_surface) {
  for (const auto& [name, mesh] : hard::small_closed_meshes<TypeParam>()) {
    const auto scene = Scene<TypeParam>::build(mesh.view());
    for (const auto& v : mesh.vertices) {
      ASSERT_TRUE(scene.crossings({v, {1, 2, 3}}).origin_on_surface) << name;
    }
  }
}

// A ray that does not see the triangle it starts on is asked about the mesh without it.
TYPED_TEST(CrossingsAgainstOracle, a_skipped_triangle_does_not_exist_not_even_under_the_origin) {
  using Real = TypeParam;
  int no_longer_on = 0, still_on = 0;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    Rng rng(hard::seed(), 11);
    const auto scene = Scene<Real>::build(mesh.view());
    for (int i = 0; i < 40; ++i) {
      const auto skipped = static_cast<std::uint32_t>(rng.below(mesh.triangles.size()));
      const Triangle& t = mesh.triangles[skipped];
      const auto& [a, b, c] =
          std::tie(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      const auto middle = [](Real p, Real q, Real r) { return p / 2 + q / 4 + r / 4; };
      const Vec3<Real> origin =
          rng.coin()
              ? a
              : Vec3<Real>{middle(a.x, b.x, c.x), middle(a.y, b.y, c.y), middle(a.z, b.z, c.z)};
      const std::vector<Ray<Real>> rays(1, {origin, hard::vec<Real>(rng, Style::Unit)});
      const std::vector<TriangleRef> skip(1, {0, skipped});
      std::vector<Crossings> found(1);
      scene.crossings(rays, found, {.skip = skip});

      Mesh<Real> without = mesh;
      without.triangles.erase(without.triangles.begin() + skipped);
      const Crossings expected = oracle::BruteForce<Real>(without.view()).crossings(rays[0]);
      ASSERT_EQ(found[0], expected) << name << show::text(rays[0]);
      const bool was_on = scene.crossings(rays[0]).origin_on_surface;
      no_longer_on += was_on && !expected.origin_on_surface ? 1 : 0;
      still_on += expected.origin_on_surface ? 1 : 0;
    }
  }
  EXPECT_GT(no_longer_on, 5);
  EXPECT_GT(still_on, 5);
}

}  // namespace
}  // namespace pierce
