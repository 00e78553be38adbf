// SPDX-License-Identifier: Apache-2.0
//
// Rays along an axis, as height scans and sections have them, aimed at corners and edges and right
// beside them: what double finds exact about them (docs/algorithm.md, "Along an axis alone")
// against the oracle, bit by bit. Grids of heights, with layers over each other, with long
// triangles among small ones, with coordinates of few bits and of many, and with numbers so small
// that filter space cannot hold them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "support/compare_scene.h"
#include "support/run_cases.h"
#include "support/save_failure.h"

namespace pierce {
namespace {

using hard::component;
using hard::Mesh;
using hard::Rng;

// What the coordinates across the axis are like.
enum class Grid : std::uint8_t { Even, Mirrored, AllBits, Uneven, Tiny, Far };
constexpr std::array kGrids{Grid::Even,   Grid::Mirrored, Grid::AllBits,
                            Grid::Uneven, Grid::Tiny,     Grid::Far};

template <class Real>
Real place_on(Grid grid, Rng& rng, int i) {
  switch (grid) {
    case Grid::Even:
      return static_cast<Real>(i - 2);
    case Grid::Mirrored:  // the first two again on the other side of 0, by heights()
      return static_cast<Real>(i - 2 - 0.3 * rng.unit());
    case Grid::AllBits:
      return static_cast<Real>(i - 2 + 0.3 * rng.unit());
    case Grid::Uneven:  // distances of many more bits than a float has
      return static_cast<Real>(std::ldexp(1 + rng.unit(), -6 * i));
    case Grid::Tiny:  // beside 0, far below what a float of filter space can be
      return i == 2 ? Real(0)
                    : static_cast<Real>((i - 2) * std::ldexp(1 + rng.unit(), -120 - 5 * i));
    case Grid::Far:
      return static_cast<Real>(4096 + i * std::ldexp(1.0, -11));
  }
  return 0;
}

// Five by five heights, some of them equal, in one to three layers; seen along `axis`.
template <class Real>
Mesh<Real> heights(Rng& rng, Grid grid, int axis) {
  Mesh<Real> mesh;
  Real across[2][5];
  for (auto& row : across) {
    for (int i = 0; i < 5; ++i) row[i] = place_on<Real>(grid, rng, i);
    if (grid == Grid::Mirrored) {  // 0 is in the middle of a cell
      row[2] = -row[1];
      row[3] = -row[0];
    }
  }
  const bool flat = rng.one_in(4);
  for (int layer = rng.between(1, 3); layer > 0; --layer) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < 25; ++i) {
      Vec3<Real> p;
      component(p, axis) = static_cast<Real>(flat         ? 0.5
                                             : rng.coin() ? rng.between(-1, 1)
                                                          : rng.symmetric());
      component(p, (axis + 1) % 3) = across[0][i % 5];
      component(p, (axis + 2) % 3) = across[1][i / 5];
      mesh.add(p);
    }
    for (std::uint32_t i = 0; i < 20; ++i) {
      if (i % 5 == 4) continue;
      const std::uint32_t a = first + i, b = a + 1, c = a + 5, d = a + 6;
      const auto put = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        if (rng.coin()) std::swap(y, z);  // either side up
        mesh.triangles.push_back({x, y, z});
      };
      put(a, b, d);
      put(a, d, c);
    }
  }
  if (rng.one_in(3)) {  // something long, through many cells
    const auto corner = [&] { return static_cast<std::uint32_t>(rng.below(25)); };
    for (int i = 0; i < 3; ++i) mesh.triangles.push_back({corner(), corner(), corner()});
  }
  for (std::size_t i = mesh.triangles.size(); i > 1; --i)
    std::swap(mesh.triangles[i - 1], mesh.triangles[rng.below(i)]);
  return mesh;
}

// Through a corner, the middle of an edge, or beside them.
template <class Real>
Ray<Real> ray_along(Rng& rng, const Mesh<Real>& mesh, int axis) {
  const Triangle& t = mesh.triangles[rng.below(mesh.triangles.size())];
  Vec3<Real> p = mesh.vertices[t[0]], q = mesh.vertices[t[1]];
  Ray<Real> ray{p, {0, 0, 0}};
  if (rng.coin()) {
    const double part = rng.coin() ? 0.5 : rng.unit();
    for (int k = 0; k < 3; ++k) {
      const double from = static_cast<double>(component(p, k));
      component(ray.origin, k) =
          static_cast<Real>(from + part * (static_cast<double>(component(q, k)) - from));
    }
  }
  Real& across = component(ray.origin, (axis + 1) % 3);
  Real& across_too = component(ray.origin, (axis + 2) % 3);
  Real& beside = rng.coin() ? across : across_too;
  if (rng.one_in(4)) beside = hard::nudged(beside, rng.between(-1, 1));
  if (rng.one_in(12)) beside += std::numeric_limits<Real>::denorm_min();
  if (rng.one_in(6))
    beside += static_cast<Real>(std::ldexp(rng.symmetric(), -rng.between(20, 100)));
  if (rng.one_in(4)) {  // on a corner's line through 0, or next to it, by less than double keeps
    const int place = rng.coin() ? rng.between(26, 30) : rng.between(24, 60);
    const double part = std::ldexp(1 + rng.unit(), -place);
    const auto on_line = [&](int k) {
      return static_cast<Real>(part * static_cast<double>(component(p, (axis + k) % 3)));
    };
    across = on_line(1);
    across_too = hard::nudged(on_line(2), rng.between(-1, 1));
  }
  Real& along = component(ray.direction, axis);
  along = static_cast<Real>((rng.coin() ? 1 : -1) * (rng.coin() ? 1 : 1 + rng.unit()));
  if (rng.one_in(8)) {  // all but along it; filter space may have it as 0
    component(ray.direction, (axis + 1) % 3) = std::numeric_limits<Real>::denorm_min();
    along *= static_cast<Real>(std::ldexp(1.0, rng.between(0, 60)));
  }
  if (rng.coin()) {
    component(ray.origin, axis) -= (along > 0 ? 1 : -1) * static_cast<Real>(rng.between(1, 8));
  } else {  // from a corner's own height, or to it
    ray.t_min = rng.coin() ? 0 : -2;
    if (rng.one_in(3)) ray.t_max = rng.coin() ? 0 : 1;
  }
  return ray;
}

template <class Real>
class AlongAxis : public testing::Test {
 public:
  // Of these, what is seen of such sides.
  static std::vector<Hit<Real>> seen(const std::vector<Hit<Real>>& hits, Sides sides) {
    std::vector<Hit<Real>> kept;
    for (const auto& hit : hits) {
      if ((hit.facing == Facing::Front) == (sides == Sides::Front) || sides == Sides::Both)
        kept.push_back(hit);
    }
    return kept;
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(AlongAxis, Reals);

TYPED_TEST(AlongAxis, corners_and_edges_are_hit_exactly) {
  using Real = TypeParam;
  std::uint64_t on_feature = 0, rays_cast = 0;
  for (std::uint64_t i = 0; i < hard::case_count(80); ++i) {
    Rng rng(hard::seed(), 500 + i);
    const int axis = rng.between(0, 2);
    const Mesh<Real> mesh = heights<Real>(rng, kGrids[i % kGrids.size()], axis);
    const BuildOptions build{.quality = rng.one_in(4) ? Quality::Compact : Quality::Balanced};
    const auto scene = Scene<Real>::build(mesh.view(), build);
    const oracle::BruteForce<Real> truth(mesh.view());
    std::vector<Ray<Real>> rays;
    std::vector<std::vector<Hit<Real>>> expected;
    for (int k = 0; k < 40; ++k) {
      const auto ray = ray_along(rng, mesh, axis);
      const auto found = oracle::difference_on_one_ray(scene, truth, ray);
      ASSERT_FALSE(found) << "seed " << hard::seed() << " case " << i << " axis " << axis << "\n"
                          << show::text(ray) << *found << "\n"
                          << hard::saved(show::text(ray) + "\n" + show::text(mesh));
      rays.push_back(ray);
      expected.push_back(truth.all_hits(ray));
      ++rays_cast;
      if (!expected.back().empty()) {
        const auto& hit = expected.back().front();
        on_feature += hit.u == 0 || hit.v == 0 || hit.w == 0 ? 1 : 0;
      }
    }
    for (const Sides sides : {Sides::Both, Sides::Front, Sides::Back}) {
      std::vector<std::vector<Hit<Real>>> of_sides;
      for (std::size_t k = 0; k < rays.size(); ++k) {
        of_sides.push_back(this->seen(expected[k], sides));
        const auto& hits = of_sides.back();
        const auto closest = scene.closest_hit(rays[k], {.sides = sides}).value_or(Hit<Real>{});
        ASSERT_TRUE(show::same_bits(closest, hits.empty() ? Hit<Real>{} : hits.front()))
            << "seed " << hard::seed() << " case " << i << ' ' << show::text(rays[k])
            << show::text(closest) << "\n  true hits:" << show::text<Real>(hits);
      }
      const auto found = oracle::difference_on_batch<Real>(scene, rays, of_sides, {.sides = sides});
      ASSERT_FALSE(found) << "seed " << hard::seed() << " case " << i << "\n" << *found;
    }
  }
  if (hard::enough_cases(80)) {
    EXPECT_GT(on_feature, rays_cast / 4);
  }
}

}  // namespace
}  // namespace pierce
