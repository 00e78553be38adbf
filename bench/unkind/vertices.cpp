// SPDX-License-Identifier: Apache-2.0
//
// Rays that start on the mesh itself, as those for thickness, occlusion and visibility do: each
// meets all triangles around its vertex at t = 0.
#include <cstddef>

#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

// From vertices of a ball, or from so far below each, in all directions.
Subject from_vertices(double below, bool in_double, const Detail& detail) {
  Prng random(67);
  Shape shape = sphere(detail.levels(6));
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const Double3& p = shape.vertices[std::size_t{i} * 7919 % shape.vertices.size()];
    rays.push_back({(1 - below) * p, random.on_sphere()});
  }
  Subject subject = asked(std::move(shape), std::move(rays));
  subject.in_double = in_double;
  return subject;
}

// From each of some vertices exactly to another one.
Subject between_vertices(bool to_vertex, const Detail& detail) {
  Shape shape = sphere(detail.levels(6));
  const std::size_t count = shape.vertices.size();
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const Double3& p = shape.vertices[std::size_t{i} * 7919 % count];
    const Double3& q = shape.vertices[(std::size_t{i} * 104729 + 1) % count];
    rays.push_back({to_vertex ? p : 0.999 * p, q - p});
  }
  Subject subject = asked(std::move(shape), std::move(rays));
  subject.in_double = true;
  return subject;
}

}  // namespace

void add_vertices(std::vector<UnkindScene>& scenes) {
  const auto from = [](double below, bool in_double) {
    return [=](const Detail& d) { return from_vertices(below, in_double, d); };
  };
  scenes.push_back({"from-vertices", "a ball, rays that start at its vertices", "just below them",
                    Ask::Closest, from(0, false), from(0.01, false)});
  scenes.push_back({"from-vertices-double", "the same in double", "just below them", Ask::Closest,
                    from(0, true), from(0.01, true)});
  scenes.push_back({"between-vertices", "in double, from vertex to vertex", "from just below",
                    Ask::Closest, [](const Detail& d) { return between_vertices(true, d); },
                    [](const Detail& d) { return between_vertices(false, d); }});
}

}  // namespace pierce::bench
