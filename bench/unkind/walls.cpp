// SPDX-License-Identifier: Apache-2.0
//
// A town of boxes: rays that start on its floors, roofs and walls. As it was drawn, and turned by
// 90 degrees, as file formats with another axis up have it: sine and cosine make 1e-17 of its
// zeros.
#include <cmath>
#include <numbers>

#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

// A parallelogram of n x n cells.
void add_wall(Shape& shape, const Double3& o, const Double3& e, const Double3& f, unsigned n) {
  for (unsigned i = 0; i <= n; ++i) {
    for (unsigned j = 0; j <= n; ++j)
      shape.vertices.push_back(o + (1.0 * i / n) * e + (1.0 * j / n) * f);
  }
  add_cells(shape, n);
}

double height_of(unsigned x, unsigned y) { return 1 + 0.7 * ((7 * x + 13 * y) % 5); }

// Of x * x boxes, two apart, on a floor.
Shape town(unsigned x) {
  Shape shape;
  const double size = 2 * x;
  add_wall(shape, {0, 0, 0}, {size, 0, 0}, {0, size, 0}, 4 * x);
  for (unsigned k = 0; k < x * x; ++k) {
    const double h = height_of(k / x, k % x), l = 1.2;
    const Double3 o{2.0 * (k / x) + 0.4, 2.0 * (k % x) + 0.4, 0};
    add_wall(shape, o, {l, 0, 0}, {0, 0, h}, 4);
    add_wall(shape, o + Double3{0, l, 0}, {l, 0, 0}, {0, 0, h}, 4);
    add_wall(shape, o, {0, l, 0}, {0, 0, h}, 4);
    add_wall(shape, o + Double3{l, 0, 0}, {0, l, 0}, {0, 0, h}, 4);
    add_wall(shape, o + Double3{0, 0, h}, {l, 0, 0}, {0, l, 0}, 4);
  }
  return shape;
}

constexpr unsigned kTown = 9;

// From its roofs and floors, or from `above` them.
Rays upward(double above, bool straight, const Detail& detail) {
  Prng random(79);
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const unsigned x = static_cast<unsigned>(random.unit() * kTown);
    const unsigned y = static_cast<unsigned>(random.unit() * kTown);
    const bool roof = random.unit() < 0.5;
    const double at = roof ? 0.4 + 1.2 * random.unit() : 0.35 * random.unit();
    const Double3 o{2.0 * x + at, 2.0 * y + 0.4 + 1.2 * random.unit(),
                    (roof ? height_of(x, y) : 0) + above};
    const Double3 d = random.on_sphere();
    rays.push_back({o, straight ? Double3{0, 0, 1} : Double3{d.x, d.y, std::abs(d.z)}});
  }
  return rays;
}

// Down onto every half of a cell's side.
Rays onto_edges(double beside, const Detail& detail) {
  Rays rays;
  const unsigned side = detail.count(44);
  for (unsigned i = 0; i < side * side; ++i) {
    rays.push_back({{0.25 * (i / side) + beside, 0.25 * (i % side) + beside, 8}, {0, 0, -1}});
  }
  return rays;
}

// The axis that was up lies down.
Subject turned(Subject subject) {
  const double sine = std::sin(std::numbers::pi / 2), cosine = std::cos(std::numbers::pi / 2);
  const auto turn = [=](Double3& p) {
    p = {p.x, cosine * p.y - sine * p.z, sine * p.y + cosine * p.z};
  };
  for (Double3& p : subject.shape.vertices) turn(p);
  for (Ray<double>& ray : subject.rays) {
    turn(ray.origin);
    turn(ray.direction);
  }
  return subject;
}

Subject in_double(Subject subject) {
  subject.in_double = true;
  return subject;
}

}  // namespace

void add_walls(std::vector<UnkindScene>& scenes) {
  const auto from = [](double above, bool straight) {
    return [=](const Detail& d) { return asked(town(kTown), upward(above, straight, d)); };
  };
  scenes.push_back({"from-walls", "a town of boxes, rays from its floors and roofs",
                    "from above them", Ask::Closest, from(0, false), from(0.01, false)});
  scenes.push_back({"from-walls-double", "the same in double", "from above them", Ask::Closest,
                    [=](const Detail& d) { return in_double(from(0, false)(d)); },
                    [=](const Detail& d) { return in_double(from(0.01, false)(d)); }});
  scenes.push_back({"turned-walls", "the town turned by 90 degrees, straight up from its floors",
                    "not turned", Ask::Closest,
                    [=](const Detail& d) { return turned(from(0, true)(d)); }, from(0, true)});
  scenes.push_back(
      {"turned-edges", "looked at from above, onto edges", "beside them", Ask::Closest,
       [](const Detail& d) { return turned(asked(town(kTown), onto_edges(0, d))); },
       [](const Detail& d) { return turned(asked(town(kTown), onto_edges(0.0917, d))); }});
}

}  // namespace pierce::bench
