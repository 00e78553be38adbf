// SPDX-License-Identifier: Apache-2.0
//
// A ray exactly through a vertex hits every triangle of its fan, one exactly through an edge hits
// both sides, and an ulp beside it what is true there. Coordinates are multiples of 2^-40 (2^-19
// for float), so that such rays can be had without rounding although the float copies of the
// vertices, which the wide kernels see, are rounded: the sharpest attack on what those discard.
// Only the triangles around the target are asked, one by one, so large meshes and many rays are
// cheap.
#include <gtest/gtest.h>

#include <algorithm>
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
constexpr int kGrid = sizeof(Real) == 4 ? 19 : 40;

template <class Real>
Real on_grid(double x) {
  return static_cast<Real>(std::ldexp(std::nearbyint(std::ldexp(x, kGrid<Real>)), -kGrid<Real>));
}

template <class Real>
struct FanRay {
  Ray<Real> ray;
  std::vector<std::uint32_t> around;  // the triangles that the target belongs to
};

template <class Real>
class Fans : public testing::Test {
 public:
  /// Brought to the grid, about the size of 1.
  static Mesh<Real> gridded(Mesh<Real> mesh, double scale) {
    for (auto& v : mesh.vertices) {
      const auto moved = [&](Real x) { return on_grid<Real>(static_cast<double>(x) * scale); };
      v = {moved(v.x), moved(v.y), moved(v.z)};
    }
    return mesh;
  }

  static FanRay<Real> draw(Rng& rng, const Mesh<Real>& mesh,
                           const std::vector<std::vector<std::uint32_t>>& fans) {
    const Triangle& triangle = mesh.triangles[rng.below(mesh.triangles.size())];
    const std::size_t corner = rng.below(3);
    const std::uint32_t from = triangle[corner], to = triangle[(corner + 1) % 3];
    const Vec3<Real> a = mesh.vertices[from], b = mesh.vertices[to];
    FanRay<Real> fan;
    Vec3<Real> target = a;
    if (rng.coin()) {
      fan.around = fans[from];
    } else {
      const auto eighths = static_cast<Real>(rng.between(1, 7)) / 8;  // exact: three bits more
      target = {a.x + (b.x - a.x) * eighths, a.y + (b.y - a.y) * eighths,
                a.z + (b.z - a.z) * eighths};
      std::set_intersection(fans[from].begin(), fans[from].end(), fans[to].begin(), fans[to].end(),
                            std::back_inserter(fan.around));
    }
    const auto coordinate = [&] { return on_grid<Real>(2 * rng.symmetric()); };
    const Real x = coordinate(), y = coordinate(), z = coordinate();
    Vec3<Real> o{x, y, z};
    if (rng.one_in(4)) o = mesh.vertices[rng.below(mesh.vertices.size())];
    if (rng.one_in(4)) hard::component(o, rng.below(3)) = hard::component(target, rng.below(3));
    fan.ray = {o, {target.x - o.x, target.y - o.y, target.z - o.z}};
    if (rng.one_in(3)) {
      Real& moved = hard::component(rng.coin() ? fan.ray.origin : fan.ray.direction, rng.below(3));
      moved = hard::nudged(moved, rng.coin() ? 1 : -1);
    }
    return fan;
  }

  static void expect_whole_fans(const std::string& name, const Mesh<Real>& mesh,
                                std::uint64_t count) {
    std::vector<std::vector<std::uint32_t>> fans(mesh.vertices.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      for (const std::uint32_t corner : mesh.triangles[i]) fans[corner].push_back(i);
    }
    std::vector<Ray<Real>> rays;
    std::vector<FanRay<Real>> drawn;
    for (std::uint64_t i = 0; i < count; ++i) {
      Rng rng(hard::seed(), i);
      drawn.push_back(draw(rng, mesh, fans));
      if (!hard::is_valid(drawn.back().ray)) {
        drawn.pop_back();
        continue;
      }
      rays.push_back(drawn.back().ray);
    }
    const auto scene = Scene<Real>::build(mesh.view());
    const auto all = scene.all_hits(rays);
    std::vector<Hit<Real>> closest(rays.size());
    scene.closest_hits(rays, closest);
    std::size_t on_edges = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto hits = all.of(i);
      ASSERT_TRUE(show::same_bits(closest[i], hits.empty() ? Hit<Real>{} : hits[0]))
          << name << " closest hit of " << show::text(rays[i]);
      for (const std::uint32_t id : drawn[i].around) {
        const auto& [a, b, c] = mesh.triangles[id];
        const auto& v = mesh.vertices;
        const auto exact =
            oracle::LineAndTriangle(rays[i], v[a], v[b], v[c]).hit(rays[i], Range::Closed);
        const auto found = std::find_if(hits.begin(), hits.end(),
                                        [&](const auto& hit) { return hit.triangle == id; });
        const auto expected = exact ? oracle::rounded<Real>(*exact, 0, id) : Hit<Real>{};
        const Hit<Real> got = found == hits.end() ? Hit<Real>{} : *found;
        ASSERT_TRUE(show::same_bits(expected, got))
            << name << ", seed " << hard::seed() << " ray " << i << " triangle " << id << "\n"
            << show::text(hard::Case<Real>{rays[i], v[a], v[b], v[c]})
            << "\nfound:    " << show::text(got) << "\nexpected: " << show::text(expected);
        on_edges += exact && (expected.u == 0 || expected.v == 0 || expected.w == 0) ? 1 : 0;
      }
    }
    EXPECT_GT(on_edges, count) << name << ": too few rays go exactly through edges";
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Fans, Reals);

TYPED_TEST(Fans, of_small_triangles_are_hit_whole) {
  using Real = TypeParam;
  this->expect_whole_fans("bunny", this->gridded(hard::bunny<Real>(), 1), hard::case_count(10000));
}

TYPED_TEST(Fans, of_triangles_of_every_size_are_hit_whole) {
  using Real = TypeParam;
  for (const int levels : {0, 1, 3, 5}) {
    this->expect_whole_fans("icosphere", this->gridded(hard::icosphere<Real>(levels), 1),
                            hard::case_count(5000));
  }
}

TYPED_TEST(Fans, of_thin_triangles_are_hit_whole) {
  using Real = TypeParam;
  this->expect_whole_fans("thin torus", this->gridded(hard::torus<Real>(400, 5), 1),
                          hard::case_count(5000));
  this->expect_whole_fans("thinner torus", this->gridded(hard::torus<Real>(5, 400), 0.7),
                          hard::case_count(5000));
}

}  // namespace
}  // namespace pierce
