// SPDX-License-Identifier: Apache-2.0
//
// Rays that do not see everything, and scenes of which there is hardly anything to see.
#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

Rays across(const Detail& detail) {
  return aimed(detail.count(kRays), 1, [](Prng& random) { return in_shell(random, 2, 4); });
}

// A ball, of which the rays see these sides only.
Subject sided(const Detail& detail, Sides sides) {
  Subject subject = asked(sphere(detail.levels(6)), across(detail));
  subject.sides = sides;
  return subject;
}

// A ball in a coarser one, which the rays do not see, or do.
Subject wrapped(const Detail& detail, bool hidden) {
  Shape shape = sphere(detail.levels(6));
  const Shape wrapping = sphere(detail.levels(4), 1.05);
  append(shape, wrapping);
  Subject subject = asked(std::move(shape), across(detail));
  if (hidden) subject.hidden = wrapping.triangles.size();
  return subject;
}

Subject one_triangle(const Detail& detail) {
  Shape shape;
  shape.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  shape.triangles = {{0, 1, 2}};
  return asked(std::move(shape), across(detail));
}

}  // namespace

void add_seen(std::vector<UnkindScene>& scenes) {
  const auto both_sides = [](const Detail& d) { return sided(d, Sides::Both); };
  scenes.push_back({"front-only", "a ball, only the front of its triangles counts", "both sides",
                    Ask::Closest, [](const Detail& d) { return sided(d, Sides::Front); },
                    both_sides});
  scenes.push_back({"back-only", "only the back counts", "both sides", Ask::Closest,
                    [](const Detail& d) { return sided(d, Sides::Back); }, both_sides});
  scenes.push_back({"hidden", "a ball in another one that masks hide", "which they do not",
                    Ask::Closest, [](const Detail& d) { return wrapped(d, true); },
                    [](const Detail& d) { return wrapped(d, false); }});
  scenes.push_back({"one-triangle", "a scene of one triangle", "a ball of 82,000", Ask::Closest,
                    one_triangle, both_sides});
  scenes.push_back({"cube", "twelve triangles", "a ball of 82,000", Ask::Closest,
                    [](const Detail& d) { return asked(cube(1), across(d)); }, both_sides});
}

}  // namespace pierce::bench
