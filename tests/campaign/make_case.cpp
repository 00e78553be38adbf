// SPDX-License-Identifier: Apache-2.0
//
// What is asked of a scene: which rays, with which ends, how many at once; which points.
#include <algorithm>
#include <cmath>

#include "campaign/case.h"
#include "campaign/hit_oracle.h"
#include "campaign/meshes.h"
#include "campaign/origins.h"
#include "campaign/point_oracle.h"
#include "campaign/targets.h"

namespace pierce::campaign {
namespace {

/// Pairs of a ray and a triangle that the oracle may look at for one case: keeps most cases at a
/// small fraction of a second.
constexpr std::size_t kSmallWork = 100'000, kMuchWork = 1'000'000, kLargeWork = 6'000'000;

std::size_t count_for(Rng& rng, std::size_t triangles, std::size_t work) {
  const std::size_t most = std::max<std::size_t>(1, work / std::max<std::size_t>(1, triangles));
  std::size_t wanted = rng.pick<std::size_t>({1, 2, 15, 16, 17, 40, 40, 40, 100, 255, 256, 257});
  if (rng.one_in(16)) wanted = rng.pick<std::size_t>({1000, 5000});
  return std::min(wanted, most);
}

/// An end of the range: at a hit of the ray, next to one, or anywhere.
template <class Real>
Real any_end(Rng& rng, const std::vector<ExactHit>& line) {
  if (!line.empty() && !rng.one_in(3)) {
    const Real t = rounded<Real>(rng.pick(line).t);
    if (std::isfinite(t)) return nudged(t, rng.one_in(2) ? 0 : rng.between(-2, 2));
    return t;
  }
  switch (rng.below(6)) {
    case 0:
      return -kInfinity<Real>;
    case 1:
      return kInfinity<Real>;
    case 2:
      return rng.pick({Real(0), Real(-0.0), Real(1), Real(-1)});
    case 3:
      return any_size<Real>(rng);
    default:
      return Real(rng.within(4));
  }
}

template <class Real>
void choose_ends(Rng& rng, const Surroundings<Real>& around, Ray<Real>& ray) {
  const Point o = as_point(ray.origin), d = as_point(ray.direction);
  const auto line = line_hits(candidates(around.world, o, d), o, d);
  ray.t_min = any_end<Real>(rng, line);
  ray.t_max = rng.one_in(2) ? kInfinity<Real> : any_end<Real>(rng, line);
  if (ray.t_min > ray.t_max && !rng.one_in(8)) std::swap(ray.t_min, ray.t_max);
}

template <class Real>
void add_bundle(Rng& rng, const Surroundings<Real>& around, std::size_t count, Case<Real>& made) {
  auto rays = bundle(rng, around, count);
  if (rng.one_in(2)) {
    Ray<Real> model = rays[rays.size() / 2];
    choose_ends(rng, around, model);
    for (auto& ray : rays) ray.t_min = model.t_min, ray.t_max = model.t_max;
  }
  made.rays.insert(made.rays.end(), rays.begin(), rays.end());
}

/// Where most triangles have to be decided exactly, fewer rays will do.
template <class Real>
std::size_t bearable_rays(Rng& rng, const Surroundings<Real>& around) {
  constexpr std::size_t kExactWork = 20'000, kSamples = 4;
  std::size_t most = 1;
  for (std::size_t i = 0; i < kSamples && around.world.size() < 10'000; ++i) {
    const Ray<Real> ray = aimed_ray(rng, around);
    const World near = candidates(around.world, as_point(ray.origin), as_point(ray.direction));
    most = std::max(most, near.size());
  }
  return kExactWork / most + 1;
}

template <class Real>
void add_rays(Rng& rng, const Surroundings<Real>& around, std::size_t work, Case<Real>& made) {
  const std::size_t count =
      std::min(count_for(rng, around.world.size(), work), bearable_rays(rng, around));
  if (rng.one_in(2)) {
    add_bundle(rng, around, count, made);
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      made.rays.push_back(aimed_ray(rng, around));
      if (rng.one_in(i < 200 ? 3 : 20)) choose_ends(rng, around, made.rays.back());
    }
  }
  // A few odd ones among many alike.
  for (std::size_t i = 0; i < count && rng.one_in(2); ++i) {
    made.rays[rng.below(count)] = aimed_ray(rng, around);
  }
}

template <class Real>
void add_skips(Rng& rng, const Surroundings<Real>& around, Case<Real>& made) {
  for (const auto& ray : made.rays) {
    TriangleRef skip;
    if (!around.world.empty() && !rng.one_in(3)) {
      const Point o = as_point(ray.origin), d = as_point(ray.direction);
      const auto& all = around.world;
      const auto near = rng.one_in(2) && all.size() < 1000 ? candidates(all, o, d) : World{};
      skip = rng.pick(near.empty() ? all : near).ref;
    }
    made.skip.push_back(skip);
  }
}

/// Masks of few bits, so that about half of the geometries are seen.
template <class Real>
void add_limits(Rng& rng, Case<Real>& made) {
  const auto mask = [&] { return rng.pick({0u, 1u, 2u, 3u, 6u, 0x80000001u, kAllBits}); };
  if (rng.one_in(2)) made.sides = rng.pick({Sides::Front, Sides::Back});
  if (rng.one_in(3)) made.max_hits = rng.pick<std::uint64_t>({0, 1, 2, 3, 7, 100});
  if (rng.one_in(2)) return;
  if (rng.one_in(2)) made.mask = mask();
  for (std::size_t i = 0; i < made.meshes.size(); ++i) made.geometry_masks.push_back(mask());
  for (std::size_t i = 0; i < made.rays.size(); ++i) made.ray_masks.push_back(mask());
  if (rng.one_in(3)) made.ray_masks.clear();
  if (rng.one_in(6)) made.geometry_masks.clear();
}

template <class Real>
void add_points(Rng& rng, const Surroundings<Real>& around, std::size_t work, Case<Real>& made) {
  const std::size_t count = std::min<std::size_t>(count_for(rng, around.world.size(), work / 4),
                                                  rng.one_in(10) ? 600 : 40);
  for (std::size_t i = 0; i < count; ++i) {
    made.points.push_back(any_point(rng, around));
    Real radius = kInfinity<Real>;
    if (rng.one_in(3) && around.world.size() < 1000) {
      const auto nearest = nearest_of(around.world, as_point(made.points.back()));
      if (nearest) radius = rounded_root<Real>(nearest->square);
      if (std::isfinite(radius)) radius = nudged(radius, rng.between(-1, 1));
    }
    if (rng.one_in(10)) radius = std::fabs(any_size<Real>(rng));
    made.radii.push_back(std::max(radius, Real(0)));
  }
}

template <class Real>
void add_cells(Rng& rng, const Surroundings<Real>& around, Case<Real>& made) {
  const int n = rng.between(1, 6);
  const auto spacing = [&](int cells) {
    return rng.one_in(3) ? Real(rng.pick({0.5, 1.0, 2.0}))
                         : finite<Real>(2.2 * around.size / cells);
  };
  const auto start = [&](double middle) {
    return rng.one_in(3) ? Real(rng.between(-2, 2)) / 2 : finite<Real>(middle - 1.1 * around.size);
  };
  Cells<Real> cells;
  auto& grid = cells.grid;
  grid.origin = {start(around.centre.x), start(around.centre.y), start(around.centre.z)};
  grid.size = {static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(rng.between(1, 6)),
               static_cast<std::uint32_t>(rng.between(1, 20))};
  grid.spacing = {spacing(n), spacing(3), spacing(10)};
  cells.first = static_cast<std::uint32_t>(rng.below(grid.size[0]));
  cells.layers = static_cast<std::uint32_t>(rng.between(1, n - static_cast<int>(cells.first)));
  const auto bad = [](Real x, Real step, std::uint32_t count) {
    return !(step > 0) || !std::isfinite(x) || !std::isfinite(x + step * Real(count));
  };
  if (bad(grid.origin.x, grid.spacing.x, grid.size[0]) ||
      bad(grid.origin.y, grid.spacing.y, grid.size[1]) ||
      bad(grid.origin.z, grid.spacing.z, grid.size[2])) {
    return;
  }
  made.cells = cells;
}

template <class Real>
Case<Real> make(Rng& rng) {
  const bool large = rng.one_in(150);
  auto [name, meshes] = large ? large_meshes<Real>(rng) : small_meshes<Real>(rng);
  Case<Real> made;
  made.name = name;
  made.meshes = std::move(meshes);
  if (!large) add_origin(rng, made);
  const auto any_quality = [&] { return static_cast<Quality>(rng.below(4)); };
  made.qualities = {any_quality()};
  if (!large) made.qualities.push_back(any_quality());
  made.build_threads = rng.one_in(2) ? 1 : 2;
  const Surroundings<Real> around(made.meshes);
  const std::size_t work = large ? kLargeWork : rng.one_in(12) ? kMuchWork : kSmallWork;
  add_rays(rng, around, work, made);
  made.range = rng.one_in(2) ? Range::Closed : Range::OpenStart;
  if (rng.one_in(2)) add_skips(rng, around, made);
  if (rng.one_in(2)) add_limits(rng, made);
  made.rule = static_cast<InsideRule>(rng.below(3));
  made.open_mesh = rng.one_in(2);
  if (rng.one_in(2)) add_points(rng, around, work, made);
  if (!large && rng.one_in(4)) add_cells(rng, around, made);
  return made;
}

}  // namespace

AnyCase make_case(std::uint64_t seed, std::uint64_t number) {
  Rng rng(seed * 0x9e3779b97f4a7c15u + number);
  if (rng.one_in(2)) return make<float>(rng);
  return make<double>(rng);
}

}  // namespace pierce::campaign
