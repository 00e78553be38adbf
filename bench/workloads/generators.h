// SPDX-License-Identifier: Apache-2.0
//
// How each mesh is made. Deterministic, from fixed seeds.
#pragma once

#include "workloads/mesh.h"

namespace pierce::bench {

Mesh make_bunny();
Mesh make_fine_bunny();
Mesh make_city();
Mesh make_needles();
Mesh make_hall();
Mesh make_stadium();
Mesh make_terrain();
Mesh make_big_terrain();

/// Each triangle becomes four; new vertices lie at edge midpoints, moved by up to `jitter` times
/// the edge's length along each axis. Edges stay shared, so what was closed stays closed.
void subdivide(std::vector<Vec3<float>>& vertices, std::vector<Triangle>& triangles, double jitter);

}  // namespace pierce::bench
