// SPDX-License-Identifier: Apache-2.0
//
// Points: what is nearest, what is inside, how far it is, and grids of them.
#include <optional>

#include "campaign/check.h"
#include "campaign/edge_oracle.h"
#include "campaign/point_oracle.h"
#include "campaign/rng.h"

namespace pierce::campaign {
namespace {

auto at_point(const std::string& built, std::size_t i) {
  return [&built, i] { return built + ", point " + std::to_string(i); };
}

/// What the scene has to say of locations, or that it has to refuse.
template <class Real>
struct Inside {
  const Case<Real>& made;
  World world;  // what counts of it
  bool refuses;
  Point direction;

  Inside(const Case<Real>& one, const World& all)
      : made(one), world(one.rule == InsideRule::Unique ? without_repeats(all) : all) {
    const EdgeCounts edges(world);
    refuses = !made.open_mesh &&
              !(made.rule == InsideRule::NonZero ? edges.watertight : edges.watertight_even);
    // Closed surfaces give the same answer in every direction: so not the library's.
    direction = made.open_mesh ? Point{0, 0, 1} : Point{0.3, -0.7, 0.55};
  }
  [[nodiscard]] Location of(const Point& p) const {
    return located(world, p, direction, made.rule);
  }
  [[nodiscard]] LocateOptions options(unsigned threads) const {
    return {.rule = made.rule, .open_mesh = made.open_mesh, .work = {.threads = threads}};
  }
};

/// Calls, and says whether the call was refused because the mesh is not closed.
template <class Call>
bool refused(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::NotClosed) throw;
    return true;
  }
  return false;
}

template <class Real>
Real signed_by(Real distance, Location location) {
  return location == Location::Inside && distance != 0 ? -distance : distance;
}

template <class Real>
void check_locations(const Inside<Real>& inside, const Scenes<Real>& scenes, Tally& tally) {
  const auto& points = inside.made.points;
  std::vector<Location> wanted;
  std::vector<Real> wanted_distance;
  if (!inside.refuses) {
    for (const auto& p : points) {
      wanted.push_back(inside.of(as_point(p)));
      const auto nearest = nearest_of(inside.world, as_point(p));
      wanted_distance.push_back(
          signed_by(rounded_nearest(nearest, kInfinity<Real>).distance, wanted.back()));
    }
  }
  for (const auto& built : scenes) {
    for (const unsigned threads : {1u, 2u}) {
      const auto options = inside.options(threads);
      std::vector<Location> got(points.size());
      std::vector<Real> distance(points.size());
      const bool no = refused([&] { built.scene.locate(points, got, options); });
      tally.compare("locate refused", inside.refuses, no, at_point(built.name, 0));
      if (no || inside.refuses) break;
      built.scene.signed_distances(points, distance, options);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto at = at_point(built.name, i);
        tally.compare("locate of a batch", wanted[i], got[i], at);
        tally.compare("signed_distances", wanted_distance[i], distance[i], at);
        if (threads == 2) continue;
        tally.compare("locate", wanted[i], built.scene.locate(points[i], options), at);
        tally.compare("signed_distance", wanted_distance[i],
                      built.scene.signed_distance(points[i], options), at);
      }
    }
  }
}

template <class Real>
Point centre_of(const Grid<Real>& grid, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  const auto along = [](Real origin, Real spacing, std::uint32_t index) {
    const Ratio half(2 * static_cast<unsigned long>(index) + 1, 2);
    return double{rounded<Real>(Ratio(double{origin}) + half * Ratio(double{spacing}))};
  };
  return {along(grid.origin.x, grid.spacing.x, i), along(grid.origin.y, grid.spacing.y, j),
          along(grid.origin.z, grid.spacing.z, k)};
}

template <class Real>
std::vector<Location> filled(const Inside<Real>& inside, const Cells<Real>& cells) {
  std::vector<Location> wanted;
  const auto& [grid, first, layers] = cells;
  for (std::uint32_t i = first; i < first + layers; ++i) {
    for (std::uint32_t j = 0; j < grid.size[1]; ++j) {
      for (std::uint32_t k = 0; k < grid.size[2]; ++k) {
        wanted.push_back(inside.of(centre_of(grid, i, j, k)));
      }
    }
  }
  return wanted;
}

template <class Real>
void check_cells(const Inside<Real>& inside, const Scenes<Real>& scenes, Tally& tally) {
  const Cells<Real>& cells = *inside.made.cells;
  const auto& grid = cells.grid;
  std::vector<Location> wanted;
  if (!inside.refuses) wanted = filled(inside, cells);
  for (const auto& built : scenes) {
    for (const unsigned threads : {1u, 2u}) {
      std::vector<Location> got(std::size_t{cells.layers} * grid.size[1] * grid.size[2]);
      const bool no = refused([&] {
        built.scene.voxelise(grid, cells.first, cells.layers, got, inside.options(threads));
      });
      tally.compare("voxelise refused", inside.refuses, no, at_point(built.name, 0));
      if (no || inside.refuses) break;
      for (std::size_t i = 0; i < got.size(); ++i) {
        tally.compare("voxelise", wanted[i], got[i], at_point(built.name, i));
      }
    }
  }
}

}  // namespace

template <class Real>
void check_inside(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                  Tally& tally) {
  if (made.points.empty() && !made.cells) return;
  const Inside<Real> inside(made, world);
  if (!made.points.empty()) check_locations(inside, scenes, tally);
  if (made.cells) check_cells(inside, scenes, tally);
}

template <class Real>
void check_nearest(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                   Tally& tally) {
  const auto& points = made.points;
  if (points.empty()) return;
  std::vector<NearestPoint<Real>> free, within;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto nearest = nearest_of(world, as_point(points[i]));
    free.push_back(rounded_nearest(nearest, kInfinity<Real>));
    within.push_back(rounded_nearest(nearest, made.radii[i]));
  }
  for (const auto& built : scenes) {
    for (const unsigned threads : {1u, 2u}) {
      std::vector<NearestPoint<Real>> got(points.size()), got_within(points.size());
      built.scene.nearest_points(points, got, {.work = {.threads = threads}});
      built.scene.nearest_points(points, got_within,
                                 {.radii = made.radii, .work = {.threads = threads}});
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto at = at_point(built.name, i);
        tally.compare("nearest_points", free[i], got[i], at);
        tally.compare("nearest_points within", within[i], got_within[i], at);
        if (threads == 2) continue;
        tally.compare("nearest_point", free[i],
                      built.scene.nearest_point(points[i]).value_or(NearestPoint<Real>{}), at);
        const auto one = built.scene.nearest_point(points[i], made.radii[i]);
        tally.compare("nearest_point within", within[i], one.value_or(NearestPoint<Real>{}), at);
      }
    }
  }
}

template void check_inside(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_inside(const Case<double>&, const Scenes<double>&, const World&, Tally&);
template void check_nearest(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_nearest(const Case<double>&, const Scenes<double>&, const World&, Tally&);

}  // namespace pierce::campaign
