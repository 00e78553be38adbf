// SPDX-License-Identifier: Apache-2.0
//
// Ways to answer the questions of an unkind scene. All of them answer in the same words, one number
// a question: t or infinity (Closest), how many (AllHits, Count), 1 or 0 (NextOrigin), Location
// (Locate, Voxelise), distance (SignedDistance, Nearest).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "unkind/subject.h"

namespace pierce::bench {

struct Way {
  std::string name;           ///< one, batch, embree, cgal
  std::size_t questions = 0;  ///< the first so many of the subject's; slow ways leave out the rest
  /// Answers them on one thread; what was built for it lives as long as this.
  std::function<void(std::vector<double>& answers)> ask;
};

/// Adds pierce's ways: question by question (but Voxelise), and in batches.
void add_pierce_ways(const Subject& subject, Ask ask, std::vector<Way>& ways);
/// Adds Embree's default scene, ray by ray, in float: Closest, AllHits, Count, Locate (the parity
/// of a ray upwards) and Nearest (its point query). Nothing for what it cannot do.
void add_embree_way(const Subject& subject, Ask ask, std::vector<Way>& ways);
/// Adds CGAL's AABB tree over exact predicates: Closest, Count, Nearest, and Locate by its
/// Side_of_triangle_mesh if the mesh is a manifold of floats.
void add_cgal_way(const Subject& subject, Ask ask, std::vector<Way>& ways);

}  // namespace pierce::bench
