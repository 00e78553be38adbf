// SPDX-License-Identifier: Apache-2.0
//
// Grids are locate at every centre: on closed meshes, on soups with the open-mesh option (where the
// very ray matters), on grids whose centres lie on vertices, edges and faces.
#include "pierce/voxelise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/closed_meshes.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
class Voxelise : public testing::Test {
 public:
  struct Counts {
    std::size_t inside = 0, on_surface = 0, outside = 0;
  };

  static void expect_locate(const std::string& name, const Scene<Real>& scene,
                            const Grid<Real>& grid, Counts& counts, LocateOptions options = {}) {
    std::vector<Location> cells(grid.cells());
    voxelise(scene, grid, cells, options);
    std::vector<Vec3<Real>> centres;
    for (std::uint32_t i = 0; i < grid.size[0]; ++i) {
      for (std::uint32_t j = 0; j < grid.size[1]; ++j) {
        for (std::uint32_t k = 0; k < grid.size[2]; ++k) centres.push_back(grid.centre(i, j, k));
      }
    }
    std::vector<Location> expected(centres.size());
    scene.locate(centres, expected, options);
    for (std::size_t n = 0; n < cells.size(); ++n) {
      ASSERT_EQ(cells[n], expected[n]) << name << " cell " << n << show::text(centres[n]);
      ++(cells[n] == Location::Inside      ? counts.inside
         : cells[n] == Location::OnSurface ? counts.on_surface
                                           : counts.outside);
    }
    options.work.threads = 1;
    std::vector<Location> layer(grid.cells() / grid.size[0] * 2);
    scene.voxelise(grid, 1, 2, layer, options);
    ASSERT_TRUE(std::equal(layer.begin(), layer.end(),
                           cells.begin() + static_cast<std::ptrdiff_t>(layer.size() / 2)))
        << name << ": two layers by themselves";
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Voxelise, Reals);

TYPED_TEST(Voxelise, every_cell_of_a_closed_mesh_is_what_locate_says_of_its_centre) {
  using Real = TypeParam;
  typename TestFixture::Counts counts;
  for (const auto& [name, mesh] : hard::small_closed_meshes<Real>()) {
    for (const Quality quality : {Quality::Balanced, Quality::High, Quality::Compact}) {
      const auto scene = Scene<Real>::build(mesh.view(), {.quality = quality});
      this->expect_locate(name, scene,
                          {{Real(-1.3), Real(-1.4), Real(-1.1)},
                           {Real(0.13), Real(0.11), Real(0.07)},
                           {40, 37, 55}},
                          counts);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(counts.inside, 10000U);
  EXPECT_GT(counts.outside, 10000U);
}

// Centres at the multiples of 1/2: vertices, edges, faces, and columns in the planes of triangles.
TYPED_TEST(Voxelise, lattice_aligned_grids_find_vertices_edges_and_upright_faces) {
  using Real = TypeParam;
  typename TestFixture::Counts counts;
  Rng rng(hard::seed(), 8);
  const Grid<Real> grid{{Real(-0.75), Real(-1.25), Real(-1.75)}, {0.5, 0.5, 0.5}, {17, 18, 19}};
  for (int i = 0; i < 6; ++i) {
    const auto mesh = hard::random_voxels<Real>(rng, 6);
    this->expect_locate("voxels", Scene<Real>::build(mesh.view()), grid, counts);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(counts.on_surface, 3000U);
  EXPECT_GT(counts.inside, 500U);
}

// On a soup every column has passages that only the ray along +z sees, in either direction.
TYPED_TEST(Voxelise, open_meshes_are_what_the_ray_along_z_says_under_both_rules) {
  using Real = TypeParam;
  typename TestFixture::Counts counts;
  const Grid<Real> grid{{-4.5, -4.75, -5.125}, {1, 0.5, 0.25}, {9, 18, 40}};
  for (std::uint64_t i = 0; i < hard::case_count(20); ++i) {
    Rng rng(hard::seed(), i);
    const Style style = rng.coin() ? Style::SmallInteger : Style::Lattice;
    auto mesh = hard::soup<Real>(rng, style, static_cast<std::uint32_t>(1 + rng.below(12)));
    if (rng.one_in(3)) mesh = hard::copies(rng, mesh, 2);
    const auto rule = rng.coin() ? InsideRule::Odd : InsideRule::NonZero;
    this->expect_locate("soup " + std::to_string(i), Scene<Real>::build(mesh.view()), grid, counts,
                        {.rule = rule, .open_mesh = true});
    if (testing::Test::HasFatalFailure()) return;
  }
  if (hard::enough_cases(20)) {
    EXPECT_GT(counts.on_surface, 100U);
    EXPECT_GT(counts.inside, 10000U);
    EXPECT_GT(counts.outside, 10000U);
  }
}

// Rounded once: 0.1f + 2.5f * 0.1f in float would give another number.
TYPED_TEST(Voxelise, centres_are_correctly_rounded) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Rng rng(hard::seed(), i);
    const Grid<Real> grid{hard::vec<Real>(rng, Style::Cad),
                          {static_cast<Real>(rng.unit() + 0.001), 1, 1},
                          {kNone, 1, 1}};
    const auto index = static_cast<std::uint32_t>(rng.below(1 << 21));
    using oracle::Dyadic;
    const Dyadic exact = Dyadic(grid.origin.x) + Dyadic(index + 0.5) * Dyadic(grid.spacing.x);
    ASSERT_EQ(grid.centre(index, 0, 0).x, oracle::round_dyadic<Real>(exact)) << i;
  }
}

TYPED_TEST(Voxelise, a_bad_grid_is_refused_by_name) {
  using Real = TypeParam;
  const auto mesh = hard::lattice_cube<Real>(1);
  const auto scene = Scene<Real>::build(mesh.view());
  const auto message = [&](const Grid<Real>& grid, std::size_t cells) -> std::string {
    std::vector<Location> room(cells);
    try {
      voxelise(scene, grid, room);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  const Grid<Real> good{{0, 0, 0}, {1, 1, 1}, {2, 3, 4}};
  EXPECT_EQ(message(good, 24), "no error");
  EXPECT_EQ(message(good, 23),
            "there are 24 cells but room for 23 results; make room for one a cell");
  Grid<Real> bad = good;
  bad.spacing.y = 0;
  EXPECT_EQ(message(bad, 24), "grid: the spacing along y must be finite and greater than 0");
  bad = good;
  bad.origin.z = kInfinity<Real>;
  EXPECT_EQ(message(bad, 24), "grid: its cells along z must all have finite coordinates");
  bad = good;
  bad.spacing.x = std::numeric_limits<Real>::max();
  EXPECT_EQ(message(bad, 24), "grid: its cells along x must all have finite coordinates");
  bad = good;
  bad.size[0] = (1U << 21) + 1;
  EXPECT_EQ(message(bad, 24), "grid: 2097153 cells along x, at most 2097152 will do");
  std::vector<Location> room(24);
  EXPECT_THROW(scene.voxelise(good, 1, 2, room), Error);
  bad = good;
  bad.size[1] = 0;
  EXPECT_EQ(message(bad, 0), "no error");
}

TYPED_TEST(Voxelise, an_open_mesh_is_refused) {
  using Real = TypeParam;
  auto mesh = hard::lattice_cube<Real>(1);
  mesh.triangles.pop_back();
  const auto scene = Scene<Real>::build(mesh.view());
  std::vector<Location> cells(8);
  const Grid<Real> grid{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  EXPECT_THROW(voxelise(scene, grid, cells), Error);
  voxelise(scene, grid, cells, {.open_mesh = true});
}

}  // namespace
}  // namespace pierce
