// SPDX-License-Identifier: Apache-2.0
//
// Is a mesh closed? Inside and outside make sense only if it is.
#pragma once

#include <cstdint>
#include <optional>

#include "pierce/error.h"
#include "pierce/options.h"
#include "pierce/types.h"

namespace pierce {

/// When two corners of triangles are the same vertex.
enum class SameVertex : std::uint8_t {
  Index,     ///< they have the same index
  Position,  ///< their coordinates are equal (-0 equals 0); for meshes whose vertices are not
             ///< shared
};

/// An edge and how the triangles of the mesh use it.
struct EdgeUse {
  std::uint32_t triangle = kNone;        ///< the first triangle that has the edge
  std::uint32_t from = 0, to = 0;        ///< vertex indices, in the direction of that triangle
  std::uint32_t other_triangle = kNone;  ///< the second triangle that has the edge, if any
  std::uint64_t forward = 0;             ///< how many triangles run from `from` to `to`
  std::uint64_t backward = 0;            ///< how many run the other way

  friend bool operator==(const EdgeUse&, const EdgeUse&) = default;
};

/// What `closedness` found. An edge is counted once, whichever way its triangles run.
struct Closedness {
  /// Every edge is used exactly once each way.
  bool closed = true;

  /// Every edge is used as often one way as the other. All that crossings and winding numbers
  /// need: closed surfaces that touch along edges or coincide in faces are balanced. Every closed
  /// mesh is.
  bool balanced = true;

  /// Every edge is used an even number of times, whichever way. All that parity needs: a closed
  /// surface some of whose triangles face the wrong way is even. Every balanced mesh is.
  bool even = true;

  /// Balanced, or would be if every edge were cut where others on its line end: a T-junction, where
  /// one triangle's edge faces two edges of others, lets nothing through. Decided exactly, for
  /// SameVertex::Position; by index it is `balanced`. With it crossings and winding numbers mean as
  /// much as on a balanced mesh.
  bool watertight = true;

  /// The same of `even`, and as much as parity needs. Every watertight mesh is.
  bool watertight_even = true;

  std::uint64_t edges = 0;
  std::uint64_t open_edges = 0;  ///< used by a single triangle
  std::uint64_t unbalanced_edges =
      0;                            ///< used more often one way than the other, open ones included
  std::uint64_t odd_edges = 0;      ///< used an odd number of times, open ones included
  std::uint64_t crowded_edges = 0;  ///< balanced, but used more than once each way
  /// Of the unbalanced edges, those that are balanced once cut; of the odd ones, those then even.
  std::uint64_t unbalanced_in_pieces = 0, odd_in_pieces = 0;

  /// The first in order of triangles, then corners: of those that cutting does not pair, if there
  /// are such.
  std::optional<EdgeUse> first_unbalanced;
  std::optional<EdgeUse> first_odd;
  std::optional<EdgeUse> first_crowded;
};

/// Tests whether a mesh is closed, and if not says where. A triangle of which two corners are the
/// same vertex has nothing to close and does not count. An empty mesh is closed.
///
/// Throws Error (IndexOutOfRange) naming the first triangle that names a missing vertex and how
/// many there are, or (Stopped). Takes about 36 bytes of memory a triangle. Thread-safe. Of the
/// options, `progress` and `statistics` mean nothing here.
template <class Real>
[[nodiscard, gnu::visibility("default")]] Closedness closedness(MeshView<Real> mesh,
                                                                SameVertex same = SameVertex::Index,
                                                                const WorkOptions& work = {});

extern template Closedness closedness(MeshView<float>, SameVertex, const WorkOptions&);
extern template Closedness closedness(MeshView<double>, SameVertex, const WorkOptions&);

}  // namespace pierce
