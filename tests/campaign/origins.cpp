// SPDX-License-Identifier: Apache-2.0
#include "campaign/origins.h"

#include <algorithm>
#include <cmath>

#include "campaign/exact.h"

namespace pierce::campaign {
namespace {

template <class Real>
bool is_finite(const Vec3<Real>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Real>
Mesh<Real> placed_mesh(const Mesh<Real>& mesh, const Transform<Real>& transform) {
  Mesh<Real> result = mesh;
  for (auto& v : result.vertices) {
    if (is_finite(v)) v = placed_vertex(transform, v);  // others are those that nobody uses
  }
  return result;
}

template <class Real>
bool is_usable(const Mesh<Real>& mesh) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](auto i) { return is_finite(mesh.vertices[i]); });
  });
}

template <class Real>
Transform<Real> any_transform(Rng& rng) {
  Transform<Real> transform;
  const auto kind = rng.below(7);
  for (std::size_t i = 0; i < 3 && kind > 0; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      Real& m = transform.rows[i][j];
      switch (kind) {
        case 1:
          m = j == 3 ? Real(rng.between(-3, 3)) : m;
          break;
        case 2:
          m = Real(rng.between(-2, 2));
          break;
        case 3:
          m = Real(rng.within(2));
          break;
        case 4:
          m = any_size<Real>(rng);
          break;
        case 5:
          m = j == 3 ? Real(rng.within(1e6)) : Real(std::ldexp(m, rng.between(-60, 60)));
          break;
        default:
          m = rng.one_in(3) ? Real(-0.0) : Real(std::ldexp(rng.within(1), -rng.between(0, 90)));
      }
    }
  }
  return transform;
}

template <class Real>
void add_instances(Rng& rng, Case<Real>& made) {
  auto& origin = made.origin;
  origin.sources = std::move(made.meshes);
  origin.placed_later = rng.one_in(2);
  made.meshes.clear();
  for (int left = rng.between(1, 4); left > 0; --left) {
    Placement<Real> placement{rng.below(origin.sources.size()), any_transform<Real>(rng)};
    const auto& source = origin.sources[placement.mesh];
    Mesh<Real> placed = placed_mesh(source, placement.transform);
    if (!is_usable(placed)) {
      placement.transform = {};
      placed = source;
    }
    origin.placements.push_back(placement);
    made.meshes.push_back(std::move(placed));
  }
  made.name += ", instances";
}

template <class Real>
void add_past(Rng& rng, Case<Real>& made) {
  made.origin.before = made.meshes;
  made.origin.in_place = rng.one_in(2);
  const auto kind = rng.below(5);
  const int power = rng.between(-20, 20);
  for (auto& mesh : made.origin.before) {
    const auto now = mesh.vertices;
    for (auto& v : mesh.vertices) {
      switch (kind) {
        case 0:
          v = {0, 0, 0};
          break;
        case 1:
          v = in_cube<Real>(rng, 1);
          break;
        case 2:
          v = rng.pick(now);
          break;
        case 3:
          v = finite<Real>(std::ldexp(double{v.x}, power), std::ldexp(double{v.y}, power),
                           std::ldexp(double{v.z}, power));
          break;
        default:
          v = nudged(rng, v, 3);
      }
      if (!is_finite(v)) v = {1, 2, 3};
    }
  }
  made.name += ", refitted";
}

}  // namespace

template <class Real>
Vec3<Real> placed_vertex(const Transform<Real>& transform, const Vec3<Real>& vertex) {
  const auto row = [&](const std::array<Real, 4>& m) {
    const auto exact = [](Real x) { return Ratio(double{x}); };
    return rounded<Real>(exact(m[0]) * exact(vertex.x) + exact(m[1]) * exact(vertex.y) +
                         exact(m[2]) * exact(vertex.z) + exact(m[3]));
  };
  return {row(transform.rows[0]), row(transform.rows[1]), row(transform.rows[2])};
}

template <class Real>
void add_origin(Rng& rng, Case<Real>& made) {
  switch (rng.below(6)) {
    case 0:
      add_instances(rng, made);
      break;
    case 1:
      add_past(rng, made);
      break;
    default:
      break;
  }
}

template Vec3<float> placed_vertex(const Transform<float>&, const Vec3<float>&);
template Vec3<double> placed_vertex(const Transform<double>&, const Vec3<double>&);
template void add_origin(Rng&, Case<float>&);
template void add_origin(Rng&, Case<double>&);

}  // namespace pierce::campaign
