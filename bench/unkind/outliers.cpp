// SPDX-License-Identifier: Apache-2.0
//
// Detail beside something large or far away.
#include <fmt/format.h>

#include <cmath>

#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

constexpr unsigned kCells = 200;

Shape ground(const Detail& detail) { return hills(detail.count(kCells)); }

Subject lidar_of(Shape shape, const Detail& detail) {
  return asked(std::move(shape), lidar(detail.count(kRays)));
}

Subject scan_of(Shape shape, const Detail& detail) {
  return asked(std::move(shape), height_scan(detail.count(kRays)));
}

void add_quads(std::vector<UnkindScene>& scenes) {
  for (const unsigned km : {2U, 20U, 200U, 2000U}) {
    const auto with_quad = [km](const Detail& d) {
      return both(ground(d), square(1000.0 * km, 0));
    };
    scenes.push_back({fmt::format("quad-{}km-lidar", km),
                      fmt::format("hills of 30 m and a ground quad {} km wide, lidar", km),
                      "without the quad", Ask::Closest,
                      [=](const Detail& d) { return lidar_of(with_quad(d), d); },
                      [](const Detail& d) { return lidar_of(ground(d), d); }});
    scenes.push_back({fmt::format("quad-{}km-scan", km), "the same, height scan",
                      "without the quad", Ask::Closest,
                      [=](const Detail& d) { return scan_of(with_quad(d), d); },
                      [](const Detail& d) { return scan_of(ground(d), d); }});
  }
  const auto wide = [](const Detail& d, bool quad) {
    Subject s = lidar_of(quad ? both(ground(d), square(2e6, 0)) : ground(d), d);
    s.in_double = true;
    return s;
  };
  scenes.push_back({"quad-2000km-double", "a double scene of it, lidar", "without the quad",
                    Ask::Closest, [=](const Detail& d) { return wide(d, true); },
                    [=](const Detail& d) { return wide(d, false); }});
}

Shape with_stray(const Detail& detail) {
  Shape shape = ground(detail);
  shape.vertices.push_back({1e7, 3e6, -2e6});
  const auto last = static_cast<std::uint32_t>(shape.vertices.size() - 1);
  shape.triangles.push_back({0, 1, last});
  return shape;
}

// A heap of grains of a millimetre, a metre wide.
Shape grains(const Detail& detail) {
  return splinters(
      detail.count(5000), 0.5, [](Prng& r) { return 1e-3 * r.on_sphere(); }, 1e-3);
}

Rays onto_grains(const Detail& detail) {
  return aimed(detail.count(kRays), 0.5, [](Prng& r) {
    const Double3 d = r.on_sphere();
    return Double3{2 * d.x, 2 * d.y, 0.5 + std::abs(d.z)};
  });
}

Subject grains_at(const Double3& place, const Detail& detail, bool planet, bool in_double) {
  Shape shape = moved(grains(detail), place);
  constexpr double kRadius = 6.4e6;
  if (planet) append(shape, sphere(detail.levels(5), kRadius, place - Double3{0, 0, kRadius + 1}));
  Rays rays = onto_grains(detail);
  for (Ray<double>& ray : rays) ray.origin = ray.origin + place;
  Subject subject = asked(std::move(shape), std::move(rays));
  subject.in_double = in_double;
  subject.centre = place;
  return subject;
}

Subject at_offset(const Double3& offset, const Detail& detail) {
  Subject subject = lidar_of(moved(ground(detail), offset), detail);
  for (Ray<double>& ray : subject.rays) ray.origin = ray.origin + offset;
  subject.in_double = true;
  subject.centre = offset;
  return subject;
}

}  // namespace

void add_outliers(std::vector<UnkindScene>& scenes) {
  add_quads(scenes);
  scenes.push_back({"sky-box", "the hills in a cube of 100 km", "without the cube", Ask::Closest,
                    [](const Detail& d) { return lidar_of(both(ground(d), cube(1e5)), d); },
                    [](const Detail& d) { return lidar_of(ground(d), d); }});
  scenes.push_back({"stray-vertex", "the hills, one triangle with a corner 10,000 km away",
                    "without it", Ask::Closest,
                    [](const Detail& d) { return lidar_of(with_stray(d), d); },
                    [](const Detail& d) { return lidar_of(ground(d), d); }});
  scenes.push_back({"planet-grains", "grains of 1 mm at the origin, a planet under them",
                    "without the planet", Ask::Closest,
                    [](const Detail& d) {
                      return grains_at({0, 0, 0}, d, true, false);
                    },
                    [](const Detail& d) {
                      return grains_at({0, 0, 0}, d, false, false);
                    }});
  scenes.push_back({"planet-centred", "the same in double, the planet's centre at the origin",
                    "without the planet, at the origin", Ask::Closest,
                    [](const Detail& d) {
                      return grains_at({0, 0, 6.4e6 + 1}, d, true, true);
                    },
                    [](const Detail& d) {
                      return grains_at({0, 0, 0}, d, false, true);
                    }});
  scenes.push_back({"georeferenced", "the hills in double, 5,200 km from the origin",
                    "at the origin", Ask::Closest,
                    [](const Detail& d) {
                      return at_offset({4.5e5, 5.2e6, 312.5}, d);
                    },
                    [](const Detail& d) {
                      return at_offset({0, 0, 0}, d);
                    }});
}

}  // namespace pierce::bench
