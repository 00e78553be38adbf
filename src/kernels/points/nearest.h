// SPDX-License-Identifier: Apache-2.0
//
// The traversal to the nearest triangle, in filter space: it discards what cannot be nearest; the
// rest goes to a callback, the exact resolver. Distances in filter space are true distances times a
// power of two, so what is nearest there is nearest.
//
// What may be discarded is found without asking how well-shaped a triangle is. Let G be any vector
// (it will be the one from the point to about the nearest point of the triangle, computed as badly
// as it may be) and A, B, C the vectors from the point to the corners. A triangle is convex, so
//   distance >= min(G . A, G . B, G . C) / |G|,
// with equality if G is right; and the length of a vector to any point of the triangle is an upper
// bound. Only the rounding of those few operations is lost (docs/algorithm.md, "Nearest points").
#pragma once

#include "bvh/tree.h"
#include "kernels/candidate.h"
#include "pierce/types.h"

namespace pierce::kernels {

/// A point in filter space: each component within 2^-53 of itself of the true one (or within
/// 2^-1074), or infinite. Triangles farther away than `limit` do not matter.
struct FilterPoint {
  Vec3<double> position;
  Vec3<double> direction;  // of the position, of max-norm 1, within 2^-40; read for far points only
  double limit;
};

/// Decides what float cannot. Exact.
class NearestResolver {
 public:
  virtual ~NearestResolver() = default;
  /// Whether the challenger comes before the best one so far: nearer, or equally near with the
  /// smaller number.
  virtual bool is_nearer(const Candidate& challenger, const Candidate& best) = 0;
};

/// The nearest triangle; if none is within the limit, any one or none (primitive == kNone).
using NearestTraversal = Candidate (*)(const bvh::Tree&, const FilterPoint&, NearestResolver&,
                                       KernelCounts*);

/// The one without SIMD, in double, for points however far away.
Candidate nearest_plain(const bvh::Tree& tree, const FilterPoint& point, NearestResolver& resolver,
                        KernelCounts* counts);

}  // namespace pierce::kernels
