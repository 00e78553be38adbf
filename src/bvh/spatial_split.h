// SPDX-License-Identifier: Apache-2.0
//
// Cutting triangles in two where that separates what overlaps (Quality::High).
//
// The box of a long diagonal triangle is mostly empty. A spatial split sends it to both sides of a
// plane, each time with the smaller box of the piece there (Stich, Friedrich, Dietrich 2009,
// "Spatial splits in bounding volume hierarchies"). A primitive may then lie in several leaves; the
// answers do not change.
//
// What must hold: the boxes of all refs of a primitive together hold it. A piece's box is that of
// the whole triangle's part on its side of one plane, cut with the box of the piece it came from,
// so errors do not add up: what a point where an edge meets a plane is off by is less than
// kCutSlack, by which boxes are widened (proofs/pieces.g).
#pragma once

#include <cstdint>
#include <optional>

#include "bvh/box.h"
#include "bvh/primitive_refs.h"
#include "bvh/primitives.h"
#include "predicate/bounds.h"
#include "support/build_control.h"

namespace pierce::bvh {

using bounds::kCutSlack;

/// Sizes of the two sides.
struct Sides {
  std::uint32_t left = 0, right = 0;
};

/// A plane in space. Refs that reach over it are cut.
struct SpatialSplit {
  int axis = -1;  // -1: none
  float place = 0;
  float cost = 0;  // comparable with Split::cost
  Sides sides;     // about

  [[nodiscard]] bool found() const { return axis >= 0; }
};

/// The cheapest plane for the heuristic, not counting the budget; `weight` as in find_split.
SpatialSplit find_spatial_split(const PrimitiveRef* refs, std::uint32_t count, float weight,
                                const Primitives& primitives);

/// Writes the left refs upward from `left` and the right ones downward from `right`. Gives up and
/// returns nothing when that takes more than the room between, or when a side gets none or all.
/// Polls the control.
std::optional<Sides> partition(const PrimitiveRef* refs, std::uint32_t count,
                               const SpatialSplit& split, const Primitives& primitives,
                               PrimitiveRef* left, PrimitiveRef* right,
                               const BuildControl& control);

}  // namespace pierce::bvh
