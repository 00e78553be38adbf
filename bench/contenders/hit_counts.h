// SPDX-License-Identifier: Apache-2.0
//
// How many triangles each ray hits according to those who can be asked: what most programs build
// their inside-outside test on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pierce/types.h"
#include "workloads/mesh.h"

namespace pierce::bench {

/// One count a ray, and the seconds that asking took (one thread, ray by ray, nothing built).
struct HitCounts {
  std::vector<std::uint32_t> counts;
  double seconds = 0;
};

#ifdef PIERCE_BENCH_EMBREE
/// With a filter function that counts hits and rejects them, as Embree's manual advises.
[[nodiscard]] HitCounts embree_hit_counts(const Mesh& mesh, std::span<const Ray<float>> rays,
                                          bool robust);
#endif

}  // namespace pierce::bench
