// SPDX-License-Identifier: Apache-2.0
//
// Rays along an axis that meet what lies in planes across it, or on the lines of a grid: height
// models sampled at their own points, floors, voxels. Nothing is in general position there.
#include <cstddef>
#include <cstdint>
#include <utility>

#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

// Straight down: at the first corner of triangles, in the middle of their first edges, or inside.
enum class Aim : std::uint8_t { Corner, Edge, Inside };

Subject sampled(Shape shape, double height, Aim aim, const Detail& detail) {
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const auto& [a, b, c] = shape.triangles[std::size_t{i} * 7919 % shape.triangles.size()];
    Double3 p = shape.vertices[a];
    if (aim == Aim::Edge) p = 0.5 * p + 0.5 * shape.vertices[b];
    if (aim == Aim::Inside) p = 0.5 * p + 0.3 * shape.vertices[b] + 0.2 * shape.vertices[c];
    rays.push_back({{p.x, p.y, height}, {0, 0, -1}});
  }
  return asked(std::move(shape), std::move(rays));
}

// A square in each of 100 heights from 0.5 to 1, side by side.
Shape terraces(const Detail& detail) {
  Shape shape;
  for (int i = 0; i < 100; ++i) {
    const Double3 by{i % 10 * 3.0 - 13.5, i / 10 * 3.0 - 13.5, 0};
    append(shape, moved(square(3, 0.501 + 0.00497 * i, detail.count(20)), by));
  }
  return shape;
}

}  // namespace

void add_features(std::vector<UnkindScene>& scenes) {
  const auto on_hills = [](Aim aim) {
    return [aim](const Detail& d) { return sampled(hills(d.count(400)), 20, aim, d); };
  };
  scenes.push_back({"dem-corners", "the hills, straight down at their vertices", "at their faces",
                    Ask::Closest, on_hills(Aim::Corner), on_hills(Aim::Inside)});
  scenes.push_back({"dem-edges", "straight down at their edges", "at their faces", Ask::Closest,
                    on_hills(Aim::Edge), on_hills(Aim::Inside)});
  const auto on_terraces = [](double height) {
    return [height](const Detail& d) { return sampled(terraces(d), height, Aim::Inside, d); };
  };
  scenes.push_back({"tie-heights", "floors, half of the heights between two floats",
                    "all of them floats", Ask::Closest, on_terraces(2), on_terraces(1)});
}

}  // namespace pierce::bench
