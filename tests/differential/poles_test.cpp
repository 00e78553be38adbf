// SPDX-License-Identifier: Apache-2.0
//
// Many triangles around one corner, or on one edge, as the poles of spheres, the lids of cylinders
// and the pages of books have them: rays exactly through it, from it and right beside it, against
// the oracle, bit by bit. In any order of triangles, with vertices of their own in the same place,
// or an ulp beside it, with triangles without area, and with some that the ray lies in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "support/compare_scene.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

using hard::AimedRay;
using hard::component;
using hard::Mesh;
using hard::Rng;

// Of few bits, so that rays can be aimed without rounding; or of many.
template <class Real>
Vec3<Real> place_of(Rng& rng, bool few_bits) {
  const auto number = [&] {
    return static_cast<Real>(few_bits ? rng.between(-64, 64) / 64.0 : rng.symmetric());
  };
  return {number(), number(), number()};
}

template <class Real>
void move_a_bit(Rng& rng, Vec3<Real>& p) {
  Real& moved = component(p, rng.below(3));
  moved = hard::nudged(moved, rng.coin() ? 1 : -1);
}

// The hub, in several places of the list of vertices; `last` is another end of the edge that all
// have, or the hub again.
template <class Real>
struct Hub {
  Mesh<Real> mesh;
  Vec3<Real> hub, last;
};

template <class Real>
Hub<Real> around_hub(Rng& rng) {
  const bool few_bits = !rng.one_in(3), book = rng.one_in(3), own_hubs = rng.coin();
  Hub<Real> of;
  of.hub = place_of<Real>(rng, few_bits);
  of.last = book ? place_of<Real>(rng, few_bits) : of.hub;
  const auto count = static_cast<std::uint32_t>(rng.between(3, 60));
  const auto hub = [&] {
    Vec3<Real> p = of.hub;
    if (rng.one_in(20)) move_a_bit(rng, p);
    return own_hubs || of.mesh.vertices.empty() ? of.mesh.add(p) : 0;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = hub();
    const std::uint32_t b = rng.one_in(8)
                                ? of.mesh.add(of.hub)
                                : of.mesh.add(book ? of.last : place_of<Real>(rng, few_bits));
    const std::uint32_t c = of.mesh.add(rng.one_in(8) ? of.last : place_of<Real>(rng, few_bits));
    Triangle t{a, b, c};
    if (rng.one_in(6) && !of.mesh.triangles.empty())
      t = of.mesh.triangles[rng.below(of.mesh.triangles.size())];
    std::rotate(t.begin(), t.begin() + rng.between(0, 2), t.end());
    if (rng.coin()) std::swap(t[0], t[1]);
    of.mesh.triangles.push_back(t);
  }
  for (std::size_t i = of.mesh.triangles.size(); i > 1; --i)
    std::swap(of.mesh.triangles[i - 1], of.mesh.triangles[rng.below(i)]);
  return of;
}

template <class Real>
Ray<Real> ray_to(Rng& rng, const Hub<Real>& of) {
  const auto half = static_cast<Real>(rng.between(0, 2)) / 2;
  const Vec3<Real> p = of.hub, q = of.last;
  const Vec3<Real> to{p.x + half * (q.x - p.x), p.y + half * (q.y - p.y), p.z + half * (q.z - p.z)};
  const Vec3<Real> from = rng.one_in(4) ? of.mesh.vertices[rng.below(of.mesh.vertices.size())]
                                        : place_of<Real>(rng, true);
  Ray<Real> ray{from, {to.x - from.x, to.y - from.y, to.z - from.z}};
  if (rng.one_in(4)) ray = {to, place_of<Real>(rng, true)};
  if (rng.one_in(3)) {  // along an axis
    const auto axis = rng.below(3);
    ray = {to, {0, 0, 0}};
    component(ray.origin, axis) = static_cast<Real>(rng.between(-2, 2));
    component(ray.direction, axis) = rng.coin() ? Real(1) : Real(-1);
  }
  if (rng.one_in(6)) move_a_bit(rng, rng.coin() ? ray.origin : ray.direction);
  if (rng.one_in(4)) ray.t_max = 1;
  if (rng.one_in(6)) ray.t_min = 1;
  if (ray.direction == Vec3<Real>{0, 0, 0}) ray.direction.z = 1;
  return ray;
}

template <class Real>
class Poles : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Poles, Reals);

TYPED_TEST(Poles, rays_through_them_and_from_them) {
  using Real = TypeParam;
  for (std::uint64_t i = 0; i < hard::case_count(100); ++i) {
    Rng rng(hard::seed(), 4200 + i);
    const Hub<Real> of = around_hub<Real>(rng);
    std::vector<AimedRay<Real>> rays;
    for (int k = 0; k < 40; ++k) {
      rays.push_back(hard::with_any_range(rng, of.mesh, ray_to(rng, of)));
    }
    const BuildOptions options{.quality = rng.one_in(3) ? Quality::High : Quality::Balanced};
    const auto found = oracle::difference(of.mesh, rays, options);
    ASSERT_FALSE(found) << "seed " << hard::seed() << " case " << i << "\n" << *found;
  }
}

}  // namespace
}  // namespace pierce
