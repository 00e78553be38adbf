// SPDX-License-Identifier: Apache-2.0
//
// Meshes as buildings are modelled: a hall, all long thin triangles with fine ornaments between
// them, and a stadium, one fine thing amid many coarse ones.
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "workloads/generators.h"
#include "workloads/prng.h"

namespace pierce::bench {
namespace {

// Points on the unit circle, one a quarter turn from the other, `count` of them (a multiple of 4).
// Not evenly spaced, but the same everywhere: sin and cos are not.
std::vector<std::array<double, 2>> circle(unsigned count) {
  std::vector<std::array<double, 2>> points;
  const unsigned quarter = count / 4;
  for (unsigned turn = 0; turn < 4; ++turn) {
    for (unsigned i = 0; i < quarter; ++i) {
      const double s = 0.41421356237309503 * (2.0 * i / quarter - 1);  // tan of an eighth turn
      const double c = (1 - s * s) / (1 + s * s), d = 2 * s / (1 + s * s);
      points.push_back(turn == 0   ? std::array{c, d}
                       : turn == 1 ? std::array{-d, c}
                       : turn == 2 ? std::array{-c, -d}
                                   : std::array{d, -c});
    }
  }
  return points;
}

// A straight prism with caps: a bar of four sides, a pipe or a column of more. Two triangles a side
// from end to end.
void add_beam(Mesh& mesh, const Double3& from, const Double3& to, double radius, unsigned sides) {
  const Double3 along = normalized(to - from);
  const Double3 helper = std::abs(along.z) < 0.9 ? Double3{0, 0, 1} : Double3{1, 0, 0};
  const Double3 u = normalized(cross(along, helper)), v = cross(along, u);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : circle(sides)) {
    const Double3 out = radius * (x * u + y * v);
    mesh.vertices.push_back(to_float(from + out));
    mesh.vertices.push_back(to_float(to + out));
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % sides);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
    if (i < 2) continue;
    const std::uint32_t before = first + 2 * (i - 1);
    mesh.triangles.push_back({first, a, before});
    mesh.triangles.push_back({first + 1, before + 1, a + 1});
  }
}

// A ball, scaled and put somewhere.
void add_copy(Mesh& mesh, const Mesh& part, double scale, const Double3& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3<float>& p : part.vertices)
    mesh.vertices.push_back(to_float(at + scale * to_double(p)));
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back({first + a, first + b, first + c});
}

constexpr double kLong = 80, kWide = 30, kHigh = 18;  // of the hall, in metres

// Both long walls: windows of bars, columns between them.
void add_walls(Mesh& mesh) {
  constexpr unsigned kBays = 16;
  constexpr double kBay = kLong / kBays;
  for (const double y : {0.0, kWide}) {
    for (unsigned bay = 0; bay < kBays; ++bay) {
      const double left = bay * kBay + 0.8, right = (bay + 1) * kBay - 0.8;
      add_beam(mesh, {bay * kBay, y, 0}, {bay * kBay, y, kHigh}, 0.5, 48);
      for (unsigned i = 0; i <= 8; ++i) {
        const double x = left + (right - left) * i / 8;
        add_beam(mesh, {x, y, 2}, {x, y, kHigh - 3}, 0.03, 4);
      }
      for (unsigned i = 0; i <= 20; ++i) {
        const double z = 2 + (kHigh - 5) * i / 20;
        add_beam(mesh, {left, y, z}, {right, y, z}, 0.02, 4);
      }
    }
  }
}

// The roof: trusses across, purlins along.
void add_roof(Mesh& mesh) {
  for (unsigned i = 0; i <= 32; ++i) {
    const double x = kLong * i / 32;
    for (unsigned k = 0; k < 12; ++k) {
      const double y = kWide * k / 12, next = kWide * (k + 1) / 12;
      const double low = kHigh, high = kHigh + 1.5;
      add_beam(mesh, {x, y, low}, {x, next, high}, 0.06, 8);
      add_beam(mesh, {x, y, high}, {x, next, low}, 0.06, 8);
    }
    add_beam(mesh, {x, 0, kHigh}, {x, kWide, kHigh}, 0.1, 8);
  }
  for (unsigned k = 0; k <= 60; ++k) {
    const double y = kWide * k / 60;
    add_beam(mesh, {0, y, kHigh + 1.6}, {kLong, y, kHigh + 1.6}, 0.05, 8);
  }
}

// Pipes from wall to wall, none of them level, and cables that hang.
void add_pipes(Mesh& mesh, Prng& random) {
  for (unsigned i = 0; i < 700; ++i) {
    const Double3 from{random.between(0, kLong), 0.4, random.between(3, kHigh)};
    const Double3 to{from.x + random.between(-15, 15), kWide - 0.4, random.between(3, kHigh)};
    add_beam(mesh, from, to, random.between(0.03, 0.2), 24);
  }
  for (unsigned i = 0; i < 300; ++i) {
    const double y = random.between(1, kWide - 1), top = random.between(12, kHigh);
    const double left = random.between(0, kLong - 20), width = random.between(10, 20);
    constexpr unsigned kPieces = 40;
    for (unsigned k = 0; k < kPieces; ++k) {
      const auto at = [&](unsigned piece) {
        const double s = 2.0 * piece / kPieces - 1;
        return Double3{left + width * piece / kPieces, y, top - 3 * (1 - s * s)};
      };
      add_beam(mesh, at(k), at(k + 1), 0.015, 4);
    }
  }
}

void add_stairs(Mesh& mesh) {
  for (const double x : {10.0, 30.0, 50.0, 70.0}) {
    for (unsigned i = 0; i < 60; ++i) {
      const double y = 4 + 0.3 * i, z = 0.17 * i;
      add_beam(mesh, {x, y, z}, {x + 3, y, z}, 0.15, 4);
      add_beam(mesh, {x, y, z}, {x, y, z + 1}, 0.02, 8);
      add_beam(mesh, {x + 3, y, z}, {x + 3, y, z + 1}, 0.02, 8);
    }
    for (const double side : {x, x + 3}) add_beam(mesh, {side, 4, 1}, {side, 22, 11.2}, 0.04, 12);
  }
}

}  // namespace

Mesh make_hall() {
  Mesh mesh;
  Prng random(0xa11);
  add_walls(mesh);
  add_roof(mesh);
  add_pipes(mesh, random);
  add_stairs(mesh);
  const Mesh ball = make_icosphere(3);
  for (unsigned i = 0; i < 100; ++i) {  // on the columns and along the stairs
    const Double3 at{random.between(0, kLong), i % 2 == 0 ? 0.8 : kWide - 0.8,
                     random.between(1, kHigh)};
    add_copy(mesh, ball, 0.3, at);
  }
  // The floor.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::array{0.0, 0.0}, {kLong, 0.0}, {kLong, kWide}, {0.0, kWide}})
    mesh.vertices.push_back(to_float({x, y, 0}));
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  finish(mesh, kLandscape);
  // From one end into it.
  mesh.view.eye = {2, 6, 5};
  mesh.view.look_at = {kLong, 0.6 * kWide, 8};
  mesh.view.light = {0.5 * kLong, 0.5 * kWide, kHigh - 1};
  return mesh;
}

Mesh make_stadium() {
  Mesh mesh = make_bunny();
  const Double3 feet{mesh.box.center().x, mesh.box.lower.y, mesh.box.center().z};
  const double size = mesh.box.radius();
  const auto directions = circle(800);
  for (unsigned row = 0; row < 20; ++row) {
    const double radius = size * (40 + row), height = size * (2 + 0.6 * row);
    for (const auto& [c, s] : directions) {
      const auto place = [&](double out, double up) {
        return feet +
               Double3{(radius + size * out) * c, height + size * up, (radius + size * out) * s};
      };
      const Double3 aside = (0.12 * size) * Double3{-s, 0, c};
      add_beam(mesh, place(0, 0) - aside, place(0, 0) + aside, 0.12 * size, 4);            // seat
      add_beam(mesh, place(0.15, 0.1) - aside, place(0.15, 0.1) + aside, 0.05 * size, 4);  // back
    }
  }
  finish(mesh, kPortrait);
  mesh.view.eye = feet + size * Double3{2.2, 2, 4};
  mesh.view.look_at = feet + size * Double3{0, 0.7, 0};
  mesh.view.light = feet + size * Double3{10, 30, 20};
  return mesh;
}

}  // namespace pierce::bench
