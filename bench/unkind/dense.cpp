// SPDX-License-Identifier: Apache-2.0
//
// Many triangles at one place, and shapes whose boxes say little.
#include "unkind/shapes.h"

namespace pierce::bench {
namespace {

Shape two_sided(Shape shape) {
  const std::size_t count = shape.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b, c] = shape.triangles[i];
    shape.triangles.push_back({a, c, b});
  }
  return shape;
}

Shape copies(const Shape& shape, unsigned count) {
  Shape all;
  for (unsigned i = 0; i < count; ++i) append(all, shape);
  return all;
}

Subject ball_of(Shape shape, const Detail& detail) {
  return asked(std::move(shape), from_inside(detail.count(kRays), 0.9));
}

Subject sides_of(Shape shape, const Detail& detail, Quality quality) {
  Prng random(37);
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i)
    rays.push_back({{random.between(0, 1000), random.between(0, 1000), 5}, {0, 0, -1}});
  Subject subject = asked(std::move(shape), std::move(rays));
  subject.quality = quality;
  return subject;
}

Subject slivers(const Detail& detail, Quality quality) {
  return sides_of(fan(detail.count(10'000)), detail, quality);
}

Subject no_slivers(const Detail& detail, Quality quality) {
  return sides_of(moved(square(1000, 0, detail.count(71)), {500, 500, 0}), detail, quality);
}

// Needles along x in a column; along it they cover each other.
Subject needles(const Detail& detail, bool end_on) {
  const auto along = [](Prng& r) { return Double3{100, 0.01 * r.unit(), 0.01 * r.unit()}; };
  Shape shape = splinters(detail.count(10'000), 5, along, 0.02);
  Prng random(41);
  Rays rays;
  for (unsigned i = 0; i < detail.count(kRays); ++i) {
    const double a = random.between(-5, 5);
    const double b = random.between(-5, 5);
    rays.push_back(end_on ? Ray<double>{{-50, a, b}, {1, 0, 0}}
                          : Ray<double>{{50 + a, b, 50}, {0, 0, -1}});
  }
  return asked(std::move(shape), std::move(rays));
}

// Long tetrahedra in all directions, or short ones.
Subject diagonals(const Detail& detail, double length) {
  Shape shape = splinters(
      detail.count(10'000), 5, [length](Prng& r) { return length * r.on_sphere(); }, 0.02);
  return asked(std::move(shape), from_inside(detail.count(kRays), 5));
}

// Squares in one plane, each cut in another way: every ray meets all of them at the same t.
Subject coplanar(const Detail& detail, unsigned count) {
  Shape shape;
  for (unsigned i = 0; i < count; ++i) append(shape, square(30, 0, detail.count(80 + 7 * i)));
  return asked(std::move(shape), height_scan(detail.count(kRays)));
}

Subject flat(const Detail& detail, const std::function<Ray<double>(Prng&)>& ray) {
  Prng random(43);
  Rays rays;
  for (unsigned i = 0; i < detail.count(500); ++i) rays.push_back(ray(random));
  return asked(square(30, 0, detail.count(200)), std::move(rays));
}

Ray<double> onto_flat(Prng& random, double height, double slope) {
  const Double3 d = random.on_sphere();
  return {{random.between(-14, 14), random.between(-14, 14), height}, {d.x, d.y, slope}};
}

Subject stack(const Detail& detail, unsigned count, double far, Quality quality) {
  Prng random(47);
  Rays rays;
  for (unsigned i = 0; i < detail.count(100); ++i)
    rays.push_back({{random.unit() * 0.9, random.unit() * 0.9, -far}, {0, 0, 1}});
  Subject subject = asked(layers(detail.count(count), 0.01), std::move(rays));
  subject.quality = quality;
  return subject;
}

// Small tetrahedra, each of them moved to another's place, far from its neighbours of before.
Subject scrambled(const Detail& detail, bool anew) {
  Shape shape = splinters(
      detail.count(10'000), 5, [](Prng& r) { return 0.1 * r.on_sphere(); }, 0.1);
  Prng random(53);
  Shape after = shape;
  for (std::size_t i = 0; i < after.vertices.size(); i += 4) {
    const Double3 to = anywhere(random, {-5, -5, -5}, {5, 5, 5});
    const Double3 by = to - after.vertices[i];
    for (std::size_t k = i; k < i + 4; ++k) after.vertices[k] = after.vertices[k] + by;
  }
  Subject subject = asked(anew ? after : shape, from_inside(detail.count(500), 5));
  if (!anew) subject.moved = after.vertices;
  return subject;
}

void add_piles(std::vector<UnkindScene>& scenes) {
  const auto ball = [](const Detail& d) { return ball_of(sphere(d.levels(6)), d); };
  scenes.push_back(
      {"two-sided", "a ball of 82,000 triangles, each of them twice", "once", Ask::Closest,
       [](const Detail& d) { return ball_of(two_sided(sphere(d.levels(6))), d); }, ball});
  const auto small = [](unsigned count) {
    return [count](const Detail& d) { return ball_of(copies(sphere(3), d.count(count)), d); };
  };
  const auto one = [](const Detail& d) { return ball_of(sphere(3), d); };
  scenes.push_back({"copies-closest", "100 copies of a ball at one place", "one", Ask::Closest,
                    small(100), one});
  scenes.push_back({"copies-count", "the same, hits counted; the twin lies in shells",
                    "100 balls, one in another", Ask::Count, small(100), [](const Detail& d) {
                      Shape shells;
                      for (unsigned i = 0; i < d.count(100); ++i)
                        append(shells, sphere(3, 1 + 0.01 * i));
                      return ball_of(std::move(shells), d);
                    }});
  scenes.push_back({"coplanar-stack", "10 squares in one plane, each cut in another way", "one",
                    Ask::Closest, [](const Detail& d) { return coplanar(d, 10); },
                    [](const Detail& d) { return coplanar(d, 1); }});
}

void add_flat(std::vector<UnkindScene>& scenes) {
  const auto steep = [](const Detail& d) {
    return flat(d, [](Prng& r) { return onto_flat(r, 1, -1); });
  };
  scenes.push_back(
      {"grazing", "a square of 80,000 triangles, rays that all but lie in it", "steep rays",
       Ask::Closest,
       [](const Detail& d) { return flat(d, [](Prng& r) { return onto_flat(r, 1e-5, -1e-6); }); },
       steep});
  scenes.push_back(
      {"in-plane", "rays that lie in it", "steep rays", Ask::Closest,
       [](const Detail& d) { return flat(d, [](Prng& r) { return onto_flat(r, 0, 0); }); }, steep});
  scenes.push_back({"layers-all", "all hits of 1,000 layers", "of 30", Ask::AllHits,
                    [](const Detail& d) { return stack(d, 1000, 1, Quality::Balanced); },
                    [](const Detail& d) { return stack(d, 30, 1, Quality::Balanced); }});
  scenes.push_back({"layers-far", "from 10^6 away, Quality::High", "from near by", Ask::AllHits,
                    [](const Detail& d) { return stack(d, 1000, 1e6, Quality::High); },
                    [](const Detail& d) { return stack(d, 1000, 1, Quality::High); }});
}

}  // namespace

void add_dense(std::vector<UnkindScene>& scenes) {
  add_piles(scenes);
  add_flat(scenes);
  for (const auto& [name, quality] :
       {std::pair{"slivers", Quality::Balanced}, {"slivers-high", Quality::High}}) {
    scenes.push_back({name, "10,000 thin triangles from one corner", "as many in a grid",
                      Ask::Closest, [q = quality](const Detail& d) { return slivers(d, q); },
                      [q = quality](const Detail& d) { return no_slivers(d, q); }});
  }
  scenes.push_back({"needles-end-on", "10,000 long needles, rays along them", "rays across",
                    Ask::Closest, [](const Detail& d) { return needles(d, true); },
                    [](const Detail& d) { return needles(d, false); }});
  scenes.push_back({"diagonals", "10,000 long needles in all directions", "short ones",
                    Ask::Closest, [](const Detail& d) { return diagonals(d, 5); },
                    [](const Detail& d) { return diagonals(d, 0.05); }});
  scenes.push_back({"refit-scrambled", "10,000 grains, refitted when each is at another place",
                    "built anew", Ask::Closest, [](const Detail& d) { return scrambled(d, false); },
                    [](const Detail& d) { return scrambled(d, true); }});
}

}  // namespace pierce::bench
