// SPDX-License-Identifier: Apache-2.0
#include "unkind/shapes.h"

#include <cmath>
#include <utility>

#include "workloads/mesh.h"

namespace pierce::bench {
namespace {

// Parabolas in place of a sine, which is not the same everywhere: period 1, from -1 to 1.
double wave(double x) {
  const double y = 2 * (x - std::floor(x)) - 1;
  return 4 * y * (1 - std::abs(y));
}

template <class Height>
Shape grid_of(double size, unsigned n, const Height& height) {
  Shape shape;
  for (unsigned i = 0; i <= n; ++i) {
    for (unsigned j = 0; j <= n; ++j) {
      const double x = size * (j / static_cast<double>(n) - 0.5);
      const double y = size * (i / static_cast<double>(n) - 0.5);
      shape.vertices.push_back({x, y, height(x, y)});
    }
  }
  add_cells(shape, n);
  return shape;
}

void add_tetrahedron(Shape& shape, const Double3& at, const Double3& u, const Double3& v,
                     const Double3& w) {
  const auto a = static_cast<std::uint32_t>(shape.vertices.size());
  shape.vertices.insert(shape.vertices.end(), {at, at + u, at + v, at + w});
  shape.triangles.insert(
      shape.triangles.end(),
      {{a, a + 2, a + 1}, {a, a + 1, a + 3}, {a + 1, a + 2, a + 3}, {a, a + 3, a + 2}});
}

}  // namespace

void add_cells(Shape& shape, unsigned n) {
  const auto first = static_cast<std::uint32_t>(shape.vertices.size()) - (n + 1) * (n + 1);
  for (unsigned i = 0; i < n; ++i) {
    for (unsigned j = 0; j < n; ++j) {
      const std::uint32_t a = first + i * (n + 1) + j;
      shape.triangles.push_back({a, a + 1, a + n + 2});
      shape.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  }
}

Shape hills(unsigned n) {
  return grid_of(30, n, [](double x, double y) { return 0.1 + 0.05 * wave(0.7 * x) * wave(y); });
}

Shape square(double size, double z, unsigned n) {
  return grid_of(size, n, [z](double, double) { return z; });
}

Shape sphere(int levels, double radius, const Double3& centre) {
  const Mesh mesh = make_icosphere(levels);
  Shape shape;
  for (const Vec3<float>& p : mesh.vertices)
    shape.vertices.push_back(centre + radius * to_double(p));
  shape.triangles = mesh.triangles;
  return shape;
}

Shape cube(double size, const Double3& centre) {
  Shape shape;
  for (int i = 0; i < 8; ++i) {
    shape.vertices.push_back(centre + (size / 2) * Double3{(i & 1) != 0 ? 1.0 : -1.0,
                                                           (i & 2) != 0 ? 1.0 : -1.0,
                                                           (i & 4) != 0 ? 1.0 : -1.0});
  }
  shape.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return shape;
}

Shape splinters(unsigned count, double reach, const std::function<Double3(Prng&)>& length,
                double width) {
  Prng random(11);
  Shape shape;
  for (unsigned i = 0; i < count; ++i) {
    const Double3 at = anywhere(random, {-reach, -reach, -reach}, {reach, reach, reach});
    const Double3 u = length(random);
    const Double3 v = width * random.on_sphere();
    add_tetrahedron(shape, at, u, v, width * random.on_sphere());
  }
  return shape;
}

Shape fan(unsigned count) {
  Shape shape;
  shape.vertices.push_back({0, 0, 0});
  for (unsigned i = 0; i <= count; ++i)
    shape.vertices.push_back({1000, 1000.0 * i / count, 0.01 * (i % 7)});
  for (unsigned i = 0; i < count; ++i) shape.triangles.push_back({0, i + 1, i + 2});
  return shape;
}

Shape layers(unsigned count, double step) {
  Prng random(13);
  Shape shape;
  for (unsigned i = 0; i < count; ++i) {
    const auto height = [&] { return step * (i + 0.1 * random.unit()); };
    shape.vertices.push_back({-1, -1, height()});
    shape.vertices.push_back({3, -1, height()});
    shape.vertices.push_back({-1, 3, height()});
    shape.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return shape;
}

void append(Shape& shape, const Shape& more) {
  const auto first = static_cast<std::uint32_t>(shape.vertices.size());
  shape.vertices.insert(shape.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles)
    shape.triangles.push_back({first + a, first + b, first + c});
}

Shape both(Shape shape, const Shape& more) {
  append(shape, more);
  return shape;
}

Shape moved(Shape shape, const Double3& by) {
  for (Double3& p : shape.vertices) p = p + by;
  return shape;
}

Rays lidar(unsigned count) {
  Prng random(17);
  Rays rays;
  while (rays.size() < count) {
    const Double3 d = random.on_sphere();
    const double across = std::sqrt(d.x * d.x + d.y * d.y);
    if (across < 0.01) continue;
    rays.push_back({{1, 2, 0.6}, {d.x / across, d.y / across, random.between(-0.55, 0.2)}});
  }
  return rays;
}

Rays height_scan(unsigned count) {
  Prng random(19);
  Rays rays;
  for (unsigned i = 0; i < count; ++i)
    rays.push_back({{random.between(-14, 14), random.between(-14, 14), 20}, {0, 0, -1}});
  return rays;
}

Rays aimed(unsigned count, double radius, const std::function<Double3(Prng&)>& origin) {
  Prng random(23);
  Rays rays;
  for (unsigned i = 0; i < count; ++i) {
    const Double3 from = origin(random);
    const Double3 to = in_shell(random, 0, radius);
    rays.push_back({from, normalized(to - from)});
  }
  return rays;
}

Rays from_inside(unsigned count, double radius) {
  Prng random(29);
  Rays rays;
  for (unsigned i = 0; i < count; ++i) {
    const Double3 from = in_shell(random, 0, radius);
    rays.push_back({from, random.on_sphere()});
  }
  return rays;
}

Double3 anywhere(Prng& random, const Double3& lower, const Double3& upper) {
  const double x = random.between(lower.x, upper.x);
  const double y = random.between(lower.y, upper.y);
  return {x, y, random.between(lower.z, upper.z)};
}

Double3 in_shell(Prng& random, double inner, double outer) {
  const double radius = random.between(inner, outer);  // first: the order is part of the scene
  return radius * random.on_sphere();
}

Points scattered(unsigned count, const Double3& lower, const Double3& upper) {
  Prng random(31);
  Points points;
  for (unsigned i = 0; i < count; ++i) points.push_back(anywhere(random, lower, upper));
  return points;
}

Subject asked(Shape shape, Rays rays) {
  Subject subject;
  subject.shape = std::move(shape);
  subject.rays = std::move(rays);
  return subject;
}

Subject located(Shape shape, Points points) {
  Subject subject;
  subject.shape = std::move(shape);
  subject.points = std::move(points);
  return subject;
}

}  // namespace pierce::bench
