// SPDX-License-Identifier: Apache-2.0
//
// Something huge beside something fine: the ground under a terrain, a sky box, a survey mark, a
// stray vertex.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/meshes.h"
#include "support/rng.h"

namespace pierce::hard {

/// Adds a closed tetrahedron 2^3 to 2^40 times as large as the mesh: around it, beside it, touching
/// a vertex of it, or so flat that it is a floor. Does nothing where no number is that large.
template <class Real>
void add_outlier(Rng& rng, Mesh<Real>& mesh) {
  if (mesh.vertices.empty()) return;
  double size = 0;
  for (const auto& v : mesh.vertices) {
    for (const Real x : {v.x, v.y, v.z}) {
      if (std::isfinite(x)) size = std::max(size, std::fabs(static_cast<double>(x)));
    }
  }
  const double huge = std::ldexp(size, rng.between(3, 40));
  if (!(huge > 0) || huge * 4 > static_cast<double>(std::numeric_limits<Real>::max())) return;
  const double thick = rng.one_in(3) ? size : huge;
  const auto at = [&](double x, double y, double z) {
    return mesh.add({static_cast<Real>(x), static_cast<Real>(y), static_cast<Real>(z)});
  };
  const double away = rng.pick({0.0, 0.0, 0.5, 2.0}) * huge;
  const auto a = rng.one_in(4) ? static_cast<std::uint32_t>(rng.below(mesh.vertices.size()))
                               : at(away - huge, -huge * (1 + rng.unit()), -thick);
  const auto b = at(away + huge, -huge, -thick);
  const auto c = at(away, huge, -thick);
  const auto d = at(away, 0, rng.coin() ? thick : -2 * thick);
  mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}});
}

}  // namespace pierce::hard
