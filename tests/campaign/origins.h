// SPDX-License-Identifier: Apache-2.0
//
// Scenes that were something else before, and scenes of instances.
#pragma once

#include "campaign/case.h"
#include "campaign/rng.h"

namespace pierce::campaign {

/// The transformed vertex by its definition: exact, rounded once.
template <class Real>
Vec3<Real> placed_vertex(const Transform<Real>& transform, const Vec3<Real>& vertex);

/// Lets the case's scene come from other vertices, or makes instances of its meshes; not always.
template <class Real>
void add_origin(Rng& rng, Case<Real>& made);

extern template Vec3<float> placed_vertex(const Transform<float>&, const Vec3<float>&);
extern template Vec3<double> placed_vertex(const Transform<double>&, const Vec3<double>&);
extern template void add_origin(Rng&, Case<float>&);
extern template void add_origin(Rng&, Case<double>&);

}  // namespace pierce::campaign
