// SPDX-License-Identifier: Apache-2.0
//
// Where rays start, what they aim at, and in what bundles they come: the hard places of a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "campaign/rng.h"
#include "campaign/world.h"

namespace pierce::campaign {

/// The corners of every triangle, and a box around them that is about right.
template <class Real>
struct Surroundings {
  World world;
  Point centre{0, 0, 0};
  double size = 1;  // the largest side of the box; not 0
  explicit Surroundings(std::span<const Mesh<Real>> meshes);
};

/// A point on, at, near or far from the surface.
template <class Real>
Vec3<Real> any_point(Rng& rng, const Surroundings<Real>& around);

/// One ray, aimed; its range is 0 to infinity.
template <class Real>
Ray<Real> aimed_ray(Rng& rng, const Surroundings<Real>& around);

/// Rays that run alike around one that is aimed: as of a camera, or parallel, or the same one.
template <class Real>
std::vector<Ray<Real>> bundle(Rng& rng, const Surroundings<Real>& around, std::size_t count);

extern template struct Surroundings<float>;
extern template struct Surroundings<double>;
extern template Vec3<float> any_point(Rng&, const Surroundings<float>&);
extern template Vec3<double> any_point(Rng&, const Surroundings<double>&);
extern template Ray<float> aimed_ray(Rng&, const Surroundings<float>&);
extern template Ray<double> aimed_ray(Rng&, const Surroundings<double>&);
extern template std::vector<Ray<float>> bundle(Rng&, const Surroundings<float>&, std::size_t);
extern template std::vector<Ray<double>> bundle(Rng&, const Surroundings<double>&, std::size_t);

}  // namespace pierce::campaign
