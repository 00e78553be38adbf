// SPDX-License-Identifier: Apache-2.0
//
// The kinds of small meshes, and what is done to all of them: placed anywhere, at any size, turned,
// split into geometries, some of their vertices moved onto or next to others, some rounded to
// floats.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "campaign/meshes.h"
#include "support/outliers.h"
#include "support/shapes.h"

namespace pierce::campaign {
namespace {

template <class Real>
using Maker = std::function<Mesh<Real>(Rng&, int)>;

template <class Real>
struct Kind {
  const char* name;
  Maker<Real> make;
};

template <class Real>
Mesh<Real> ulps_apart(Rng& rng, int count) {
  Mesh<Real> mesh;
  const auto base = in_cube<Real>(rng, 2);
  for (int i = 0; i < count / 2 + 4; ++i) mesh.vertices.push_back(nudged(rng, base, 3));
  hard::connect_at_random(rng, mesh, count);
  return mesh;
}

template <class Real>
Mesh<Real> any_sizes(Rng& rng, int count) {
  Mesh<Real> mesh;
  count = std::min(count, 100);  // of numbers of 5,000 bits
  for (int i = 0; i < count; ++i) {
    mesh.vertices.push_back({any_size<Real>(rng), any_size<Real>(rng), any_size<Real>(rng)});
  }
  hard::connect_at_random(rng, mesh, count);
  return mesh;
}

template <class Real>
Mesh<Real> copies(Rng& rng, int count) {
  Mesh<Real> mesh = hard::soup<Real>(rng, 1, 1);
  while (static_cast<int>(mesh.triangles.size()) < count) {
    mesh.triangles.push_back(rng.one_in(3) ? Triangle{0, 2, 1} : Triangle{0, 1, 2});
  }
  return mesh;
}

/// Each triangle half as large as the last and as far from the corner: the deepest trees there are.
template <class Real>
Mesh<Real> telescope(Rng& rng, int count) {
  Mesh<Real> mesh = hard::soup<Real>(rng, count, 0.5);
  const int step = rng.between(1, 4), axes = rng.between(1, 7);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const int power = -static_cast<int>(i / 3) * step / 4;
    auto& v = mesh.vertices[i];
    if (axes & 1) v.x = std::ldexp(v.x, power);
    if (axes & 2) v.y = std::ldexp(v.y, power);
    if (axes & 4) v.z = std::ldexp(v.z, power);
  }
  return mesh;
}

template <class Real>
Mesh<Real> with_outlier(Rng& rng, int count) {
  Mesh<Real> mesh = hard::soup<Real>(rng, count, 0.3);
  const double far = std::ldexp(1.0, rng.between(5, 60));
  mesh.vertices[rng.below(mesh.vertices.size())] = in_cube<Real>(rng, far);
  return mesh;
}

template <class Real>
Mesh<Real> closed_pieces(Rng& rng, int count) {
  Mesh<Real> mesh = hard::split_tetrahedron<Real>(rng, count / 2, rng.one_in(2) ? 0.25 : 0.0);
  if (rng.one_in(3)) {
    for (auto& t : mesh.triangles) {
      if (rng.one_in(4)) std::swap(t[1], t[2]);  // still even, no longer balanced
    }
  }
  return mesh;
}

/// With T-junctions; sometimes with faces twice, or with a hole.
template <class Real>
Mesh<Real> junctions(Rng& rng, int count) {
  Mesh<Real> mesh = rng.coin() ? hard::boxes<Real>(rng, count / 24 + 1, 4)
                               : hard::split_tetrahedron<Real>(rng, 4, 0);
  hard::split_on_one_side(rng, mesh, count / 2);
  if (rng.one_in(3)) {
    for (std::size_t i = mesh.triangles.size(); i-- > 0;) {
      const Triangle t = mesh.triangles[i];
      mesh.triangles.push_back(rng.coin() ? t : Triangle{t[1], t[0], t[2]});
    }
  }
  if (rng.one_in(4)) mesh.triangles.pop_back();
  return mesh;
}

template <class Real>
Mesh<Real> small_torus(Rng& rng, int) {
  return hard::torus<Real>(3 + static_cast<std::uint32_t>(rng.below(10)),
                           3 + static_cast<std::uint32_t>(rng.below(7)), rng.unit());
}

template <class Real>
Mesh<Real> terrain(Rng& rng, int) {
  const int n = rng.between(1, 12), m = rng.between(1, 12);
  const int steps = rng.one_in(3) ? 0 : rng.between(1, 4);
  return hard::sheet<Real>(n, m, [&](int, int) { return rng.between(-steps, steps); });
}

template <class Real>
Mesh<Real> rough_terrain(Rng& rng, int) {
  const double height = std::ldexp(1.0, rng.between(-30, 3));
  return hard::sheet<Real>(rng.between(1, 12), rng.between(1, 12),
                           [&](int, int) { return rng.within(height); });
}

template <class Real>
Mesh<Real> on_a_line(Rng& rng, int count) {
  Mesh<Real> mesh;
  const std::array<int, 3> way{rng.between(-2, 2), rng.between(-2, 2), rng.between(-2, 2)};
  for (int i = 0; i < 12; ++i) {
    const int k = rng.between(-4, 4);
    mesh.vertices.push_back({Real(k * way[0]), Real(k * way[1]), Real(k * way[2])});
  }
  mesh.vertices.push_back({1, 2, 3});
  hard::connect_at_random(rng, mesh, count);
  return mesh;
}

template <class Real>
std::vector<Kind<Real>> kinds() {
  return {
      {"soup",
       [](Rng& r, int n) { return hard::soup<Real>(r, n, std::ldexp(1.0, r.between(-8, 1))); }},
      {"lattice",
       [](Rng& r, int n) {
         return hard::lattice<Real>(r, n, {4, 4, 4});
       }},
      {"wide lattice",
       [](Rng& r, int n) {
         return hard::lattice<Real>(r, n, {64, 64, 64});
       }},
      {"flat",
       [](Rng& r, int n) {
         return hard::lattice<Real>(r, n, {9, 9, 0});
       }},
      {"point",
       [](Rng& r, int n) {
         return hard::lattice<Real>(r, n, {0, 0, 0});
       }},
      {"line", on_a_line<Real>},
      {"copies", copies<Real>},
      {"needles", [](Rng& r, int n) { return hard::needles<Real>(r, n, r.between(0, 4)); }},
      {"fan",
       [](Rng& r, int n) { return hard::fan<Real>(r, n + 3, std::ldexp(1.0, -r.between(0, 40))); }},
      {"boxes", [](Rng& r, int n) { return hard::boxes<Real>(r, n / 12 + 1, 4); }},
      {"closed", closed_pieces<Real>},
      {"junctions", junctions<Real>},
      {"torus", small_torus<Real>},
      {"terrain", terrain<Real>},
      {"rough terrain", rough_terrain<Real>},
      {"ulps apart", ulps_apart<Real>},
      {"any sizes", any_sizes<Real>},
      {"outlier", with_outlier<Real>},
      {"telescope", telescope<Real>},
  };
}

/// Where meshes are put: each is a scale and a place for all vertices together.
template <class Real>
struct Place {
  const char* name;
  Vec3<double> scale, offset;
};

template <class Real>
Place<Real> any_place(Rng& rng) {
  using Limits = std::numeric_limits<Real>;
  const double huge = std::ldexp(1.0, Limits::max_exponent - rng.pick({1, 2, 4, 8}));
  const double tiny = double{Limits::denorm_min()} * rng.pick({1.0, 3.0, 64.0, 4096.0});
  const double one = std::ldexp(1.0, rng.between(-40, 40));
  const auto cube = [](double s) { return Vec3<double>{s, s, s}; };
  switch (rng.below(12)) {
    case 0:
      return {"huge", cube(huge), {0, 0, 0}};
    case 1:
      return {"denormal", cube(tiny), {0, 0, 0}};
    case 2:
      return {
          "georeferenced", cube(0.001 * rng.between(1, 100)), {431234.567, 5412345.678, 123.456}};
    case 3:
      return {"thin", {1, 1, rng.pick({0.0, 0x1p-60, 0x1p-30, 0x1p60})}, {0, 0, 0}};
    case 4:
      return {"power of two", cube(one), {0, 0, 0}};
    case 5:
      return {"off centre", cube(1), {rng.within(1e6), rng.within(10), 0x1p20}};
    case 6:
      return {"any scale", {0.3, 1.7, 11.1}, {0.1, -0.7, 0.3}};
    default:
      return {"as is", cube(1), {0, 0, 0}};
  }
}

template <class Real>
void spoil(Rng& rng, Mesh<Real>& mesh) {
  for (auto& v : mesh.vertices) {
    if (rng.one_in(12)) v = rng.pick(mesh.vertices);
    if (rng.one_in(6)) v = nudged(rng, rng.one_in(2) ? v : rng.pick(mesh.vertices), 2);
  }
}

template <class Real>
void turn_axes(Rng& rng, Mesh<Real>& mesh) {
  const auto turns = rng.below(3);
  const bool x = rng.one_in(2), y = rng.one_in(2), z = rng.one_in(2);
  for (auto& v : mesh.vertices) {
    for (std::uint64_t i = 0; i < turns; ++i) v = {v.y, v.z, v.x};
    v = {x ? -v.x : v.x, y ? -v.y : v.y, z ? -v.z : v.z};  // makes zeros negative, too
  }
}

/// Doubles are often floats that were widened on their way. Meshes that reach beyond floats stay
/// what they are.
template <class Real>
void make_floats(Mesh<Real>& mesh) {
  const auto in_range = [](Real x) {
    constexpr auto kMost = static_cast<Real>(std::numeric_limits<float>::max());
    constexpr auto kLeast = static_cast<Real>(std::numeric_limits<float>::min());
    return x == 0 || (std::fabs(x) >= kLeast && std::fabs(x) <= kMost);
  };
  for (const auto& v : mesh.vertices) {
    if (!in_range(v.x) || !in_range(v.y) || !in_range(v.z)) return;
  }
  const auto nearest = [](Real x) { return static_cast<Real>(static_cast<float>(x)); };
  for (auto& v : mesh.vertices) v = {nearest(v.x), nearest(v.y), nearest(v.z)};
}

/// A mesh of its own for some of the triangles; the vertices that they leave unused become NaN.
template <class Real>
std::vector<Mesh<Real>> split(Rng& rng, const Mesh<Real>& whole) {
  const int most = rng.one_in(10) ? 60 : 5;
  std::vector<Mesh<Real>> parts(rng.one_in(3) ? static_cast<std::size_t>(rng.between(2, most)) : 1);
  for (auto& part : parts) part.vertices = whole.vertices;
  std::vector<std::vector<bool>> used(parts.size(), std::vector<bool>(whole.vertices.size()));
  for (const Triangle& t : whole.triangles) {
    const auto which = rng.below(parts.size());
    parts[which].triangles.push_back(t);
    for (const auto corner : t) used[which][corner] = true;
  }
  for (std::size_t g = 0; g < parts.size(); ++g) {
    for (std::size_t i = 0; i < whole.vertices.size(); ++i) {
      if (!used[g][i]) parts[g].vertices[i].y = std::numeric_limits<Real>::quiet_NaN();
    }
  }
  return parts;
}

}  // namespace

template <class Real>
NamedMeshes<Real> small_meshes(Rng& rng) {
  static const auto kKinds = kinds<Real>();
  const Kind<Real>& kind = rng.pick(kKinds);
  int count = rng.one_in(8) ? rng.between(1, 9) : rng.between(5, 120);
  if (rng.one_in(15)) count = rng.between(500, 4000);
  Mesh<Real> mesh = kind.make(rng, count);
  const auto place = any_place<Real>(rng);
  for (auto& v : mesh.vertices) {
    v = finite<Real>(double{v.x} * place.scale.x + place.offset.x,
                     double{v.y} * place.scale.y + place.offset.y,
                     double{v.z} * place.scale.z + place.offset.z);
  }
  if (rng.one_in(4)) spoil(rng, mesh);
  if (rng.one_in(2)) turn_axes(rng, mesh);
  std::string name = std::string(kind.name) + ", " + place.name;
  if (std::is_same_v<Real, double> && rng.one_in(4)) {
    make_floats(mesh);
    name += ", floats";
  }
  if (rng.one_in(6)) {
    hard::add_outlier(rng, mesh);
    name += ", outlier";
  }
  if (rng.one_in(10)) mesh.triangles.resize(mesh.triangles.size() / 3);
  return {std::move(name), split(rng, mesh)};
}

template NamedMeshes<float> small_meshes(Rng&);
template NamedMeshes<double> small_meshes(Rng&);

}  // namespace pierce::campaign
