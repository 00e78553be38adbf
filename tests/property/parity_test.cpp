// SPDX-License-Identifier: Apache-2.0
//
// Parity, and the winding number, on every closed mesh: from inside all rays leave an odd number of
// times and one more than they enter, from outside an even number, whatever they run through:
// vertices, edges, lattice planes, faces from side to side. Known beforehand, without an oracle.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/closed_meshes.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;

template <class Real>
class Parity : public testing::Test {
 public:
  static void expect_winding(const std::string& name, const Scene<Real>& scene,
                             const std::vector<Ray<Real>>& rays, int winding) {
    std::vector<Crossings> found(rays.size());
    scene.crossings(rays, found);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(found[i].signed_count, winding) << name << show::text(rays[i]);
      ASSERT_EQ(static_cast<int>(found[i].count % 2), winding) << name << show::text(rays[i]);
    }
  }

  /// From each point through all targets and away from them.
  static std::vector<Ray<Real>> rays_through(const Vec3<Real>& from,
                                             const std::vector<Vec3<Real>>& targets) {
    std::vector<Ray<Real>> rays;
    for (const Vec3<Real>& p : targets) {
      const Vec3<Real> d{p.x - from.x, p.y - from.y, p.z - from.z};
      if (d == Vec3<Real>{0, 0, 0}) continue;
      rays.push_back({from, d});
      rays.push_back({from, {-d.x, -d.y, -d.z}});
    }
    return rays;
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Parity, Reals);

TYPED_TEST(Parity, is_right_through_every_vertex_and_edge_midpoint_of_the_bunny) {
  using Real = TypeParam;
  const auto mesh = hard::bunny<Real>();
  const auto scene = Scene<Real>::build(mesh.view());
  const auto targets = hard::vertices_and_midpoints(mesh);
  Rng rng(hard::seed(), 1);
  for (const auto& from : hard::points_inside(rng, mesh, 1)) {
    this->expect_winding("bunny", scene, this->rays_through(from, targets), 1);
  }
  this->expect_winding("bunny", scene, this->rays_through({0, 0, 8}, targets), 0);
}

// Points of the lattice (inside a cube, they are corners of voxels) and of the half lattice; every
// ray along an axis, a face diagonal or a space diagonal runs in faces, along edges or through
// corners of the surface.
TYPED_TEST(Parity, is_right_along_lattice_planes_faces_and_edges_of_a_lattice_cube) {
  using Real = TypeParam;
  constexpr int kSize = 4;
  const auto mesh = hard::lattice_cube<Real>(kSize);
  const auto scene = Scene<Real>::build(mesh.view());
  std::vector<Ray<Real>> inside, outside;
  for (int n = 0; n < 13 * 13 * 13; ++n) {
    const int at[3] = {n % 13 - 2, n / 13 % 13 - 2, n / 169 - 2};  // halves, -1 to 5
    int within = 0, beyond = 0;
    for (const int x : at) {
      within += x > 0 && x < 2 * kSize;
      beyond += x < 0 || x > 2 * kSize;
    }
    if (within != 3 && beyond == 0) continue;  // on the surface
    for (int k = 0; k < 27; ++k) {
      if (k == 13) continue;
      const auto half = [](int x) { return static_cast<Real>(x) / 2; };
      const auto step = [](int x) { return static_cast<Real>(x - 1); };
      const Ray<Real> ray{{half(at[0]), half(at[1]), half(at[2])},
                          {step(k % 3), step(k / 3 % 3), step(k / 9)}};
      (within == 3 ? inside : outside).push_back(ray);
    }
  }
  EXPECT_GT(inside.size(), 5000U);
  this->expect_winding("lattice cube", scene, inside, 1);
  this->expect_winding("lattice cube", scene, outside, 0);
}

// The same on the surfaces of random voxels, which touch themselves along edges and in corners: a
// voxel's middle is inside if it is there.
TYPED_TEST(Parity, is_right_through_all_corners_of_touching_voxels) {
  using Real = TypeParam;
  for (std::uint64_t n = 0; n < 4; ++n) {
    Rng rng(hard::seed(), n);
    std::set<std::array<int, 3>> voxels;
    for (int i = 0; i < 64; ++i) {
      if (rng.coin()) voxels.insert({i / 16, i / 4 % 4, i % 4});
    }
    const auto mesh = hard::voxel_surface<Real>(voxels);
    const auto scene = Scene<Real>::build(mesh.view());
    const auto targets = hard::vertices_and_midpoints(mesh);
    for (int i = 0; i < 64; ++i) {
      const std::array<int, 3> voxel{i / 16, i / 4 % 4, i % 4};
      const auto middle = [&](std::size_t k) { return static_cast<Real>(voxel[k]) + Real(0.5); };
      const Vec3<Real> from{middle(0), middle(1), middle(2)};
      const int winding = voxels.count(voxel) != 0 ? 1 : 0;
      this->expect_winding("voxels", scene, this->rays_through(from, targets), winding);
      ASSERT_EQ(scene.locate(from), winding == 1 ? Location::Inside : Location::Outside);
    }
  }
}

}  // namespace
}  // namespace pierce
