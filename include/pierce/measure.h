// SPDX-License-Identifier: Apache-2.0
//
// What people ask of a mesh by itself: how large it is, of how many pieces, whether it passes
// through itself. (Is it closed? See pierce/closed.h.)
#pragma once

#include <cstdint>
#include <vector>

#include "pierce/closed.h"
#include "pierce/options.h"
#include "pierce/types.h"

namespace pierce {

/// What `measure` found. Of triangles two corners of which are the same vertex only `area` and
/// `volume` know, to which they add nothing.
struct MeshMeasures {
  /// The sum of a . (b x c) / 6 over all triangles (a, b, c), rounded once: what a closed mesh
  /// encloses, negative if its triangles face inward, each part as often as it is wound around. Of
  /// an open mesh: that of the mesh and the cones from the origin to its open edges.
  double volume = 0;
  /// Of all triangles, summed with more than 250 bits and rounded once.
  double area = 0;

  std::uint64_t vertices = 0;   ///< that triangles use
  std::uint64_t edges = 0;      ///< each once, however many triangles use it
  std::uint64_t triangles = 0;  ///< with three vertices
  /// vertices - edges + triangles: 2 for a sphere, 0 for a torus, the sum over all components.
  std::int64_t euler = 0;
  std::uint64_t components = 0;  ///< pieces that have no vertex in common

  /// Where two triangles alone share an edge, they face the same way.
  bool consistent = true;
  /// Some triangles may be turned so that the mesh is consistent (a Moebius strip cannot).
  bool orientable = true;
};

/// About half a second a million triangles. Throws Error (IndexOutOfRange,
/// NonFiniteVertex) naming the first bad triangle or vertex and how many there are, (Stopped).
/// Thread-safe. Of the options, `progress` and `statistics` mean nothing here.
template <class Real>
[[nodiscard, gnu::visibility("default")]] MeshMeasures measure(MeshView<Real> mesh,
                                                               SameVertex same = SameVertex::Index,
                                                               const WorkOptions& work = {});

/// Two triangles of a mesh, first < second.
struct TrianglePair {
  std::uint32_t first = kNone, second = kNone;

  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// The pairs of triangles that share more than they should, decided exactly: any point if they have
/// no corner in common (by position); any point beside it if they have one; any point beside the
/// edge if they have two; triangles with the same three corners always. So neighbours that only
/// touch where they are joined are no pair; neighbours folded onto each other are. Triangles
/// without area are left out. In ascending order.
///
/// Throws Error (IndexOutOfRange, NonFiniteVertex, TooManyTriangles, Stopped). Thread-safe.
template <class Real>
[[nodiscard, gnu::visibility("default")]] std::vector<TrianglePair> self_intersections(
    MeshView<Real> mesh, const WorkOptions& work = {});

extern template MeshMeasures measure(MeshView<float>, SameVertex, const WorkOptions&);
extern template MeshMeasures measure(MeshView<double>, SameVertex, const WorkOptions&);
extern template std::vector<TrianglePair> self_intersections(MeshView<float>, const WorkOptions&);
extern template std::vector<TrianglePair> self_intersections(MeshView<double>, const WorkOptions&);

}  // namespace pierce
