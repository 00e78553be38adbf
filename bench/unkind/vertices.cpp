// SPDX-License-Identifier: Apache-2.0
//
// Rays that start on the mesh itself, as those for thickness, occlusion and visibility do, or end
// there: those from a vertex meet all triangles around it at t = 0, those from a face that one, or
// miss it by what rounding leaves.
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

// A point in one of the faces, as far as doubles go.
Double3 in_face(const Shape& shape, unsigned i) {
  const auto& [a, b, c] = shape.triangles[std::size_t{i} * 7919 % shape.triangles.size()];
  return 0.5 * shape.vertices[a] + 0.3 * shape.vertices[b] + 0.2 * shape.vertices[c];
}

Subject from_faces(double below, bool in_double, const Detail& detail) {
  Prng random(71);
  Shape shape = sphere(detail.levels(6));
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i)
    rays.push_back({(1 - below) * in_face(shape, i), random.on_sphere()});
  Subject subject = asked(std::move(shape), std::move(rays));
  subject.in_double = in_double;
  return subject;
}

// From within, as far as the face, or not quite.
Subject to_faces(double far, const Detail& detail) {
  Prng random(73);
  Shape shape = sphere(detail.levels(6));
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const Double3 from = 0.5 * random.on_sphere();
    rays.push_back({from, in_face(shape, i) - from, 0, far});
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
  const auto from_face = [](double below, bool in_double) {
    return [=](const Detail& d) { return from_faces(below, in_double, d); };
  };
  scenes.push_back({"from-faces", "rays that start on faces", "just below them", Ask::Closest,
                    from_face(0, false), from_face(0.01, false)});
  scenes.push_back({"from-faces-double", "the same in double", "just below them", Ask::Closest,
                    from_face(0, true), from_face(0.01, true)});
  scenes.push_back({"to-faces-double", "in double, from within as far as a face", "beyond the face",
                    Ask::Closest, [](const Detail& d) { return to_faces(1, d); },
                    [](const Detail& d) { return to_faces(1.5, d); }});
}

}  // namespace pierce::bench
