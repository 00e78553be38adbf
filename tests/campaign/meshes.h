// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are hard on a ray caster. Each kind has a name, under which its cases are counted.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "campaign/rng.h"
#include "campaign/world.h"

namespace pierce::campaign {

template <class Real>
struct NamedMeshes {
  std::string name;
  std::vector<Mesh<Real>> meshes;  // the geometries of one scene
};

/// What scene number `index` of the seed is made of: 5 to 300 triangles.
template <class Real>
NamedMeshes<Real> small_meshes(Rng& rng);

/// 10^5 to 10^6 triangles.
template <class Real>
NamedMeshes<Real> large_meshes(Rng& rng);

extern template NamedMeshes<float> small_meshes(Rng&);
extern template NamedMeshes<double> small_meshes(Rng&);
extern template NamedMeshes<float> large_meshes(Rng&);
extern template NamedMeshes<double> large_meshes(Rng&);

}  // namespace pierce::campaign
