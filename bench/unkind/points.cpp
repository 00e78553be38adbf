// SPDX-License-Identifier: Apache-2.0
//
// Questions about points: beside outliers, on the surface, in small batches, below many sheets.
#include <cmath>
#include <numbers>

#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

Points around_ball(unsigned count) { return scattered(count, {-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}); }

// Not far from its surface: from the middle all of it is equally near.
Points near_ball(unsigned count) {
  Prng random(67);
  Points points;
  for (unsigned i = 0; i < count; ++i) points.push_back(in_shell(random, 0.8, 1.2));
  return points;
}

Subject few(const Detail& detail, unsigned together, bool close) {
  Points points = close ? scattered(detail.count(1024), {0.7, 0.1, 0.1}, {0.71, 0.11, 0.11})
                        : near_ball(detail.count(1024));
  Subject subject = located(sphere(detail.levels(7)), std::move(points));
  subject.together = together;
  return subject;
}

Subject over_hills(const Detail& detail, const Shape& outlier) {
  return located(both(hills(detail.count(200)), outlier),
                 scattered(detail.count(500), {-14, -14, 0}, {14, 14, 2}));
}

Subject ball_beside(const Detail& detail, const Shape& outlier) {
  return located(both(sphere(detail.levels(6)), outlier), around_ball(detail.count(2000)));
}

Subject ball_cells(const Detail& detail, const Shape& outlier) {
  Subject subject = located(both(sphere(detail.levels(6)), outlier), {});
  const unsigned n = detail.count(64);
  subject.grid = {{-1.5, -1.5, -1.5}, {3.0 / n, 3.0 / n, 3.0 / n}, {n, n, n}};
  return subject;
}

Subject below_sheets(const Detail& detail, Quality quality) {
  Shape shape = layers(detail.count(20'000), 5e-5);
  append(shape, splinters(
                    detail.count(5000), 4, [](Prng& r) { return 4 * r.on_sphere(); }, 1e-3));
  Subject subject = located(std::move(shape), Points(16, Double3{0.1, 0.2, -0.9}));
  subject.quality = quality;
  subject.open_mesh = true;
  return subject;
}

// A column of cells whose centres all round to the height of the triangles.
Subject cells_on(const Detail& detail, unsigned count) {
  Subject subject;
  subject.shape.vertices = {{-1, -1, 1e10}, {3, -1, 1e10}, {-1, 3, 1e10}};
  subject.shape.triangles.assign(count, Triangle{0, 1, 2});
  subject.grid = {{0, 0, 1e10}, {0.1, 0.1, 1e-30}, {1, 1, detail.count(1U << 16)}};
  subject.open_mesh = true;
  return subject;
}

// Points of the surface of a ball, as far as numbers go, or `off` beside it.
Subject on_ball(const Detail& detail, bool edges, bool in_double, double off) {
  const Shape ball = sphere(detail.levels(6));
  Prng random(68);
  Points points(detail.count(2000));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Triangle& t = ball.triangles[i * 7919 % ball.triangles.size()];
    const double u = edges ? 0.5 : random.unit() / 2, v = edges ? 0 : random.unit() / 2;
    points[i] = (1 + off) * ((1 - u - v) * ball.vertices[t[0]] + u * ball.vertices[t[1]] +
                             v * ball.vertices[t[2]]);
  }
  Subject subject = located(ball, std::move(points));
  subject.in_double = in_double;
  return subject;
}

// Points at `off` from the axis of a tin: on it, all of its wall is as near as the rest.
Subject in_tin(const Detail& detail, double off) {
  const unsigned sides = detail.count(2000);
  Shape tin{{{0, 0, -100}, {0, 0, 100}}, {}};
  for (unsigned i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    const double x = 30 * std::cos(angle), y = 30 * std::sin(angle);
    const unsigned at = 2 + 2 * i, next = 2 + 2 * ((i + 1) % sides);
    tin.vertices.push_back({x, y, -100});
    tin.vertices.push_back({x, y, 100});
    for (const Triangle& t : {Triangle{at, next, next + 1}, Triangle{at, next + 1, at + 1},
                              Triangle{0, next, at}, Triangle{1, at + 1, next + 1}}) {
      tin.triangles.push_back(t);
    }
  }
  return located(std::move(tin), scattered(detail.count(200), {off, 0, -60}, {off, 0, 60}));
}

void add_nearest(std::vector<UnkindScene>& scenes) {
  const auto on = [](bool edges, bool in_double, double off) {
    return [=](const Detail& d) { return on_ball(d, edges, in_double, off); };
  };
  scenes.push_back({"nearest-on-double", "points of a ball's faces, in double", "a hundredth above",
                    Ask::Nearest, on(false, true, 0), on(false, true, 0.01)});
  scenes.push_back({"nearest-edges", "points in the middle of a ball's edges", "a hundredth above",
                    Ask::Nearest, on(true, false, 0), on(true, false, 0.01)});
  scenes.push_back({"nearest-axis", "points on the axis of a tin of 2,000 sides", "beside it",
                    Ask::Nearest, [](const Detail& d) { return in_tin(d, 0); },
                    [](const Detail& d) { return in_tin(d, 10); }});
}

void add_outlying(std::vector<UnkindScene>& scenes) {
  const auto far = [] { return cube(1, {1e7, 2e6, -3e6}); };
  scenes.push_back({"nearest-quad", "points over hills, a ground quad of 2,000 km",
                    "without the quad", Ask::Nearest,
                    [](const Detail& d) { return over_hills(d, square(2e6, 0)); },
                    [](const Detail& d) { return over_hills(d, {}); }});
  scenes.push_back({"nearest-far-cube", "points over hills, a cube 10,000 km away", "without it",
                    Ask::Nearest, [=](const Detail& d) { return over_hills(d, far()); },
                    [](const Detail& d) { return over_hills(d, {}); }});
  scenes.push_back({"locate-far-cube", "points around a ball, a cube 10^7 radii away", "without it",
                    Ask::Locate, [=](const Detail& d) { return ball_beside(d, far()); },
                    [](const Detail& d) { return ball_beside(d, {}); }});
  scenes.push_back({"voxelise-far-cube", "the cells around a ball, a cube 10^7 radii away",
                    "without it", Ask::Voxelise,
                    [=](const Detail& d) { return ball_cells(d, far()); },
                    [](const Detail& d) { return ball_cells(d, {}); }});
}

}  // namespace

void add_points(std::vector<UnkindScene>& scenes) {
  add_outlying(scenes);
  add_nearest(scenes);
  for (const auto& [name, ask, together] : {std::tuple{"locate-16", Ask::Locate, 16U},
                                            {"locate-1024", Ask::Locate, 1024U},
                                            {"signed-16", Ask::SignedDistance, 16U}}) {
    scenes.push_back({name, "few scattered points in a batch, a ball of 330,000 triangles",
                      "as many close together", ask,
                      [t = together](const Detail& d) { return few(d, t, false); },
                      [t = together](const Detail& d) { return few(d, t, true); }});
  }
  scenes.push_back({"locate-sheets-high", "16 points below 20,000 sheets, Quality::High",
                    "Balanced", Ask::Locate,
                    [](const Detail& d) { return below_sheets(d, Quality::High); },
                    [](const Detail& d) { return below_sheets(d, Quality::Balanced); }});
  scenes.push_back({"voxelise-pile", "a column of cells on 20 triangles at one place", "on one",
                    Ask::Voxelise, [](const Detail& d) { return cells_on(d, 20); },
                    [](const Detail& d) { return cells_on(d, 1); }});
}

}  // namespace pierce::bench
