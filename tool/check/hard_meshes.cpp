// SPDX-License-Identifier: Apache-2.0
#include "check/hard_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "check/lots.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

constexpr HardMeshKind kKinds[] = {
    {"sphere", "closed, vertices of full precision"},
    {"torus", "closed, slender quads at the inner rim"},
    {"voxels", "closed, integer coordinates, coplanar faces, edges that four faces share"},
    {"lattice", "three families of squares through each other, integer coordinates"},
    {"plane", "one square cut into small ones: everything coplanar and axis-parallel"},
    {"terrain", "heights over a grid"},
    {"soup", "triangles anywhere, through each other"},
    {"coincident", "the same few triangles many times, in every order of their corners"},
    {"fan", "many triangles round one vertex"},
    {"needles", "lengths and widths a million apart"},
    {"slivers", "corners in a line but for an ulp"},
    {"degenerate", "points and segments among proper triangles"},
    {"tiny", "coordinates among the denormals"},
    {"huge", "coordinates near the largest number, where products overflow"},
    {"mixed", "magnitudes from the smallest to the largest in one mesh"},
    {"far", "a small ball far from the origin: few bits left"},
    {"one", "a single triangle"},
};

template <class Real>
class Maker {
 public:
  std::uint32_t add(double x, double y, double z) {
    mesh.vertices.push_back({static_cast<Real>(x), static_cast<Real>(y), static_cast<Real>(z)});
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  }
  std::uint32_t add(const Vec3<double>& p) { return add(p.x, p.y, p.z); }

  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }

  // A surface over a grid of (n + 1) (m + 1) points, or n m points if it wraps round.
  template <class Point>
  void grid(std::uint32_t n, std::uint32_t m, bool wraps, Point point) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const std::uint32_t rows = wraps ? n : n + 1, columns = wraps ? m : m + 1;
    for (std::uint32_t i = 0; i < rows; ++i) {
      for (std::uint32_t j = 0; j < columns; ++j) add(point(i, j));
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return first + i % rows * columns + j % columns;
    };
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < m; ++j) {
        quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }

  // Poles, and rings of `columns` points between them.
  void sphere(std::uint32_t rings, std::uint32_t columns, const Vec3<double>& centre,
              double radius) {
    const std::uint32_t north = add(centre + Vec3<double>{0, 0, radius});
    for (std::uint32_t i = 1; i <= rings; ++i) {
      const double polar = std::numbers::pi * i / (rings + 1);
      for (std::uint32_t j = 0; j < columns; ++j) {
        const double turn = 2 * std::numbers::pi * j / columns;
        add(centre + radius * Vec3<double>{std::sin(polar) * std::cos(turn),
                                           std::sin(polar) * std::sin(turn), std::cos(polar)});
      }
    }
    const std::uint32_t south = add(centre - Vec3<double>{0, 0, radius});
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return north + 1 + i * columns + j % columns;
    };
    for (std::uint32_t j = 0; j < columns; ++j) {
      mesh.triangles.push_back({north, at(0, j), at(0, j + 1)});
      for (std::uint32_t i = 0; i + 1 < rings; ++i) {
        quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
      mesh.triangles.push_back({south, at(rings - 1, j + 1), at(rings - 1, j)});
    }
  }

  void triangle(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c) {
    const std::uint32_t i = add(a), j = add(b);
    mesh.triangles.push_back({i, j, add(c)});
  }

  // The surface of a random set of unit cubes.
  void voxels(int n) {
    const auto full = [n](std::array<int, 3> at) {
      for (const int x : at) {
        if (x < 0 || x >= n) return false;
      }
      return Lots(7, static_cast<std::uint64_t>((at[0] * n + at[1]) * n + at[2])).below(2) != 0;
    };
    std::map<std::array<int, 3>, std::uint32_t> corners;
    const auto corner = [&](const std::array<int, 3>& at) {
      const auto [found, is_new] = corners.try_emplace(at, 0U);
      if (is_new) found->second = add(at[0], at[1], at[2]);
      return found->second;
    };
    for (int cell = 0; cell < n * n * n; ++cell) {
      const std::array<int, 3> at = {cell / (n * n), cell / n % n, cell % n};
      if (!full(at)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
          std::array<int, 3> beyond = at;
          beyond[axis] += side == 0 ? -1 : 1;
          if (!full(beyond)) voxel_face(at, axis, side, corner);
        }
      }
    }
  }

  HardMesh<Real> mesh;

 private:
  template <class Corner>
  void voxel_face(std::array<int, 3> at, std::size_t axis, int side, Corner corner) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    at[axis] += side;
    std::array<std::array<int, 3>, 4> c = {at, at, at, at};
    ++c[1][u];
    ++c[2][u];
    ++c[2][v];
    ++c[3][v];
    if (side == 0) std::swap(c[1], c[3]);  // outward
    const std::uint32_t i = corner(c[0]), j = corner(c[1]), k = corner(c[2]);
    quad(i, j, k, corner(c[3]));
  }
};

template <class Real>
void make_coincident(Maker<Real>& maker) {
  for (int i = 0; i < 8; ++i) {
    Lots lots(11, static_cast<std::uint64_t>(i));
    const std::uint32_t a = maker.add(lots.cube()), b = maker.add(lots.cube()),
                        c = maker.add(lots.cube());
    for (int copy = 0; copy < 2; ++copy) {
      for (const Triangle& t : {Triangle{a, b, c}, Triangle{b, c, a}, Triangle{c, a, b},
                                Triangle{a, c, b}, Triangle{c, b, a}, Triangle{b, a, c}}) {
        maker.mesh.triangles.push_back(t);
      }
    }
  }
}

template <class Real>
void make_slivers(Maker<Real>& maker) {
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  for (std::uint64_t i = 0; i < 500; ++i) {
    Lots lots(13, i);
    const auto a = convert<Real>(lots.cube()), b = convert<Real>(lots.cube());
    const Real k = static_cast<Real>(lots.between(-4, 12)) / 8;
    Vec3<Real> c = a + k * (b - a);
    Real& moved = writable_component(c, lots.below(3));
    if (lots.below(4) != 0) moved = std::nextafter(moved, lots.below(2) != 0 ? kInf : -kInf);
    maker.triangle(convert<double>(a), convert<double>(b), convert<double>(c));
  }
}

template <class Real>
void make_mixed(Maker<Real>& maker) {
  using Limits = std::numeric_limits<Real>;
  const int low = Limits::min_exponent - Limits::digits + 2, high = Limits::max_exponent - 3;
  for (std::uint64_t i = 0; i < 32; ++i) {  // few: exact numbers of 4000 bits take their time
    Lots lots(17, i);
    const auto size = [&] { return std::ldexp(1.0, lots.between(low, high)); };
    const auto point = [&] {
      const double x = lots.symmetric() * size(), y = lots.symmetric() * size();
      return Vec3<double>{x, y, lots.symmetric() * size()};
    };
    const Vec3<double> a = point(), b = point();
    maker.triangle(a, b, lots.below(3) == 0 ? a + lots.unit() * (b - a) : point());
  }
}

template <class Real>
void make_degenerate(Maker<Real>& maker) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    Lots lots(19, i);
    const Vec3<double> a = lots.cube(), b = lots.cube(), c = lots.cube();
    switch (i % 4) {
      case 0:
        maker.triangle(a, a, a);
        break;
      case 1:
        maker.triangle(a, b, a);
        break;
      case 2:  // a segment of three points on a grid: exactly in a line
        maker.triangle({0, 0, 0}, {1, 2, -1}, {-2, -4, 2});
        break;
      default:
        maker.triangle(a, b, c);
    }
  }
}

template <class Real>
void make_soup(Maker<Real>& maker, int count, double size, double offset) {
  for (int i = 0; i < count; ++i) {
    Lots lots(23, static_cast<std::uint64_t>(i));
    const auto point = [&] { return size * lots.cube() + Vec3<double>{offset, offset, offset}; };
    const Vec3<double> a = point(), b = point();
    maker.triangle(a, b, point());
  }
}

template <class Real>
void make_needles(Maker<Real>& maker) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    Lots lots(29, i);
    const Vec3<double> a = lots.cube(), along = lots.cube(), across = lots.cube();
    maker.triangle(a, a + along, a + 1e-6 * across);
  }
}

template <class Real>
void make_fan(Maker<Real>& maker) {
  const std::uint32_t hub = maker.add(0.1, 0.2, 0.3);
  const std::uint32_t n = 600;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    maker.add(std::cos(turn), std::sin(turn), 0.2 * std::sin(5 * turn));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    maker.mesh.triangles.push_back({hub, hub + 1 + i, hub + 1 + (i + 1) % n});
  }
}

template <class Real>
void make_lattice(Maker<Real>& maker) {
  const std::uint32_t n = 5;
  for (std::uint32_t k = 0; k <= n; ++k) {
    maker.grid(n, n, false, [k](double i, double j) { return Vec3<double>{i, j, double(k)}; });
    maker.grid(n, n, false, [k](double i, double j) { return Vec3<double>{double(k), i, j}; });
    maker.grid(n, n, false, [k](double i, double j) { return Vec3<double>{j, double(k), i}; });
  }
}

}  // namespace

std::span<const HardMeshKind> hard_mesh_kinds() { return kKinds; }

template <class Real>
HardMesh<Real> make_hard_mesh(std::string_view name) {
  using Limits = std::numeric_limits<Real>;
  Maker<Real> maker;
  if (name == "sphere") maker.sphere(20, 40, {0, 0, 0}, 1);
  if (name == "torus") {
    maker.grid(40, 24, true, [](double i, double j) {
      const double u = 2 * std::numbers::pi * i / 40, v = 2 * std::numbers::pi * j / 24;
      const double r = 1 + 0.95 * std::cos(v);
      return Vec3<double>{r * std::cos(u), r * std::sin(u), 0.95 * std::sin(v)};
    });
  }
  if (name == "voxels") maker.voxels(8);
  if (name == "lattice") make_lattice(maker);
  if (name == "plane") {
    maker.grid(24, 24, false, [](double i, double j) { return Vec3<double>{i, j, 3}; });
  }
  if (name == "terrain") {
    maker.grid(32, 32, false, [](double i, double j) {
      return Vec3<double>{0.1 * i, 0.1 * j, 0.3 * std::sin(0.7 * i) * std::cos(0.5 * j)};
    });
  }
  if (name == "soup") make_soup(maker, 400, 1, 0);
  if (name == "coincident") make_coincident(maker);
  if (name == "fan") make_fan(maker);
  if (name == "needles") make_needles(maker);
  if (name == "slivers") make_slivers(maker);
  if (name == "degenerate") make_degenerate(maker);
  if (name == "tiny") make_soup(maker, 300, 1000 * static_cast<double>(Limits::denorm_min()), 0);
  if (name == "huge") make_soup(maker, 300, static_cast<double>(Limits::max()) / 8, 0);
  if (name == "mixed") make_mixed(maker);
  if (name == "far") maker.sphere(12, 24, {1e5, -2e5, 3e5}, 1);
  if (name == "one") maker.triangle({0.1, 0.2, 0.3}, {1.1, 0.1, 0.4}, {0.3, 0.9, -0.2});
  return std::move(maker.mesh);
}

template HardMesh<float> make_hard_mesh(std::string_view);
template HardMesh<double> make_hard_mesh(std::string_view);

}  // namespace pierce::tool
