// SPDX-License-Identifier: Apache-2.0
//
// Columns of hit points and normals are those of Scene::hit_point, normal and unit_normal, whatever
// the layout, for closest hits and for lists of all hits; a miss has NaN.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "pierce/pierce.h"
#include "support/meshes.h"
#include "support/run_cases.h"
#include "support/strided_array.h"

namespace pierce {
namespace {

template <class Real>
class PlaceColumns : public testing::Test {
 public:
  hard::Rng rng{hard::seed(), 91};
  hard::Mesh<Real> mesh = hard::copies(rng, hard::random_voxels<Real>(rng, 4), 2);
  Scene<Real> scene = Scene<Real>::build(mesh.view());

  std::vector<Ray<Real>> draw(std::size_t count) {
    std::vector<Ray<Real>> rays;
    for (std::size_t i = 0; i < count; ++i) {
      // Integers: through edges and vertices; or anything.
      const auto number = [&] {
        return rng.coin() ? Real(rng.between(-1, 5)) : Real(4 * rng.unit());
      };
      const Real x = number(), y = number();
      rays.push_back({{x, y, 9}, {0, rng.coin() ? Real(0) : Real(rng.symmetric()), -1}});
    }
    return rays;
  }

  static Vec3<Real> row(const hard::StridedArray<Real>& array, std::size_t i) {
    return {array.get(i, 0), array.get(i, 1), array.get(i, 2)};
  }
  static bool same(const Vec3<Real>& a, const Vec3<Real>& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  }
  static bool nowhere(const Vec3<Real>& p) {
    return std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z);
  }
  void expect_places(const Ray<Real>& ray, const Hit<Real>& hit, const Vec3<Real>& point,
                     const Vec3<Real>& normal, const Vec3<Real>& unit) {
    if (hit.triangle == kNone) {
      ASSERT_TRUE(nowhere(point) && nowhere(normal) && nowhere(unit));
      return;
    }
    ASSERT_TRUE(same(point, scene.hit_point(ray, hit)));
    ASSERT_TRUE(same(normal, scene.normal(hit)));
    ASSERT_TRUE(same(unit, scene.unit_normal(hit)));
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PlaceColumns, Reals);

TYPED_TEST(PlaceColumns, of_closest_hits_are_those_of_each_hit) {
  using Real = TypeParam;
  for (const hard::Layout layout : hard::kLayouts) {
    for (const bool one_by_one : {false, true}) {
      auto rays = this->draw(600);
      if (one_by_one) rays[300].direction = {0, 0, 0};  // its block goes ray by ray
      hard::StridedArray<Real> point(this->rng, layout, 600, 3), normal(this->rng, layout, 600, 3),
          unit(this->rng, layout, 600, 3);
      std::vector<Hit<Real>> hits(rays.size());
      HitArrays<Real> out;
      out.hits = hits;
      out.point = point.rows();
      out.normal = normal.rows();
      out.unit_normal = unit.rows();
      BatchOptions options{.invalid = InvalidRays::Miss};
      this->scene.closest_hits(RayArrays<Real>::of(rays), out, options);
      std::size_t found = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        this->expect_places(rays[i], hits[i], this->row(point, i), this->row(normal, i),
                            this->row(unit, i));
        found += hits[i].triangle != kNone ? 1 : 0;
      }
      EXPECT_GT(found, 100U);
      EXPECT_LT(found, 600U);
      EXPECT_TRUE(point.guards_stand() && normal.guards_stand() && unit.guards_stand());
    }
  }
}

TYPED_TEST(PlaceColumns, of_lists_are_those_of_each_hit) {
  using Real = TypeParam;
  const auto rays = this->draw(400);
  const HitLists<Real> lists = this->scene.all_hits(rays);
  std::vector<Vec3<Real>> points(lists.hits.size()), normals(points.size()), units(points.size());
  std::size_t used = 0;
  const HitRoom<Real> room = [&](std::uint64_t, std::span<const std::uint64_t> offsets) {
    const std::size_t count = offsets.back();
    HitArrays<Real> out;
    out.point = rows(std::span(points).subspan(used, count));
    out.normal = rows(std::span(normals).subspan(used, count));
    out.unit_normal = rows(std::span(units).subspan(used, count));
    used += count;
    return out;
  };
  this->scene.all_hits(RayArrays<Real>::of(rays), {}, room);
  ASSERT_EQ(used, points.size());
  ASSERT_GT(used, 400U);
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    for (std::uint64_t i = lists.offsets[ray]; i < lists.offsets[ray + 1]; ++i) {
      this->expect_places(rays[ray], lists.hits[i], points[i], normals[i], units[i]);
    }
  }
}

}  // namespace
}  // namespace pierce
