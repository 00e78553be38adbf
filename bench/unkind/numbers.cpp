// SPDX-License-Identifier: Apache-2.0
//
// Rays from far away, and numbers that make exact answers long.
#include <cmath>

#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

Subject ball_from(double distance, const Detail& detail) {
  Rays rays = aimed(detail.count(kRays), 0.9, [=](Prng& r) { return distance * r.on_sphere(); });
  return asked(sphere(detail.levels(6)), std::move(rays));
}

Subject ball_of_size(double size, const Detail& detail) {
  Rays rays = from_inside(detail.count(kRays), 0.9);
  for (Ray<double>& ray : rays) ray.origin = size * ray.origin;
  return asked(sphere(detail.levels(6), size), std::move(rays));
}

// From the centre exactly through vertices, or through somewhere in each triangle.
Subject star(Shape shape, bool to_vertices, bool in_double, const Detail& detail) {
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const auto& [a, b, c] = shape.triangles[std::size_t{i} * 7919 % shape.triangles.size()];
    const Double3& p = shape.vertices[a];
    const Double3 q = 0.5 * p + 0.25 * shape.vertices[b] + 0.25 * shape.vertices[c];
    rays.push_back({{0, 0, 0}, to_vertices ? p : q});
  }
  Subject subject = asked(std::move(shape), std::move(rays));
  subject.in_double = in_double;
  return subject;
}

// A ball of doubles whose last places lie `bits` below its size at most; all of them are in use.
Subject long_numbers(int bits, const Detail& detail) {
  Prng random(59);
  Shape shape = sphere(detail.levels(5));
  for (Double3& p : shape.vertices) {
    for (double* x : {&p.x, &p.y, &p.z}) {
      *x = std::round(*x * 1024) / 1024;
      if (std::abs(*x) >= 0.3) continue;
      const int shift = static_cast<int>(random.unit() * bits);
      *x = std::ldexp(random.between(-1, 1), -shift);
    }
  }
  return star(std::move(shape), true, true, detail);
}

// A soup of large triangles through each other.
Subject soup(const Detail& detail) {
  Prng random(61);
  Shape shape;
  const unsigned count = detail.count(3000);
  for (unsigned i = 0; i < 3 * count; ++i)
    shape.vertices.push_back(anywhere(random, {-1, -1, -1}, {1, 1, 1}));
  for (unsigned i = 0; i < count; ++i) shape.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  return asked(std::move(shape), from_inside(detail.count(50), 0.9));
}

Subject chords(const Detail& detail, bool scattered_rays) {
  const unsigned side = detail.count(128);
  Rays rays;
  if (scattered_rays) {
    rays = from_inside(side * side, 0.99);
  } else {
    for (unsigned i = 0; i < side * side; ++i) {
      const double x = (i % side + 0.5) / side - 0.5;
      const double y = (i / side + 0.5) / side - 0.5;
      rays.push_back({{0, 0, 0}, {x, y, 1}});
    }
  }
  return asked(sphere(detail.levels(7)), std::move(rays));
}

}  // namespace

void add_far_rays(std::vector<UnkindScene>& scenes) {
  const auto near = [](const Detail& d) { return ball_from(3, d); };
  scenes.push_back({"far-1e3", "a ball, rays from 10^3 radii away", "from 3", Ask::Closest,
                    [](const Detail& d) { return ball_from(1e3, d); }, near});
  scenes.push_back({"far-1e6", "a ball, rays from 10^6 radii away", "from 3", Ask::Closest,
                    [](const Detail& d) { return ball_from(1e6, d); }, near});
  scenes.push_back({"scattered-rays", "a ball of 330,000 triangles, rays in all directions",
                    "a camera's rays", Ask::Closest,
                    [](const Detail& d) { return chords(d, true); },
                    [](const Detail& d) { return chords(d, false); }});
}

void add_numbers(std::vector<UnkindScene>& scenes) {
  const auto unit = [](const Detail& d) { return ball_of_size(1, d); };
  scenes.push_back({"tiny", "a ball of radius 10^-30", "of 1", Ask::Closest,
                    [](const Detail& d) { return ball_of_size(1e-30, d); }, unit});
  scenes.push_back({"huge", "a ball of radius 10^30", "of 1", Ask::Closest,
                    [](const Detail& d) { return ball_of_size(1e30, d); }, unit});
  scenes.push_back({"through-vertices", "a ball, rays exactly through its vertices",
                    "through its faces", Ask::Closest,
                    [](const Detail& d) { return star(sphere(d.levels(6)), true, false, d); },
                    [](const Detail& d) { return star(sphere(d.levels(6)), false, false, d); }});
  scenes.push_back({"long-numbers", "doubles of up to 50 + 100 bits, rays through vertices",
                    "of 10 + 10 bits", Ask::Closest,
                    [](const Detail& d) { return long_numbers(100, d); },
                    [](const Detail& d) { return long_numbers(10, d); }});
  scenes.push_back({"longer-numbers", "of up to 50 + 300 bits", "of 10 + 10 bits", Ask::Closest,
                    [](const Detail& d) { return long_numbers(300, d); },
                    [](const Detail& d) { return long_numbers(10, d); }});
  scenes.push_back({"next-origin-soup", "where to go on in a soup of large triangles", "in a ball",
                    Ask::NextOrigin, soup, [](const Detail& d) {
                      return asked(sphere(d.levels(4)), from_inside(d.count(50), 0.9));
                    }});
}

}  // namespace pierce::bench
