// SPDX-License-Identifier: Apache-2.0
//
// The search tree: which triangles to ask. See node.h for the layout of nodes and leaves.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bvh/node.h"
#include "bvh/primitives.h"
#include "pierce/options.h"
#include "support/huge_buffer.h"

namespace pierce::bvh {

/// No path from the root passes more nodes: a traversal that keeps the children it has yet to see
/// on a stack needs at most 7 * kMaxDepth + 1 entries.
inline constexpr int kMaxDepth = 72;

/// What a leaf holds; nodes are the same in both.
enum class Layout : std::uint8_t {
  Full,     // float copies of the corners, and the numbers of the triangles
  Compact,  // the numbers alone: a traversal fetches the corners when it comes there
            // (leaf_access.h)
};

struct Tree {
  Layout layout = Layout::Full;
  HugeBuffer<Node> nodes;        // depth-first, parents before children
  HugeBuffer<std::byte> leaves;  // leaf blocks, then kLeafSlack bytes
  // Layout::Compact: where the corners are. They must stay there while the tree is traversed.
  const Primitives* primitives = nullptr;
  // An inner node, a leaf (a small scene), or kNoChild (an empty one).
  std::uint32_t root = kNoChild;
  float lower[3] = {kEmptyPlane, kEmptyPlane, kEmptyPlane};  // box of the whole, outward
  float upper[3] = {-kEmptyPlane, -kEmptyPlane, -kEmptyPlane};
  std::uint64_t leaf_blocks = 0;
  double sah_cost = 0;

  /// Throws Error (Stopped) when asked to stop.
  [[nodiscard]] Tree copy(const WorkOptions& work) const;
  [[nodiscard]] std::size_t bytes() const { return nodes.bytes() + leaves.bytes(); }
};

/// Builds the tree over all primitives. Boxes are rounded outward from the corners (a corner's own
/// error of 2^-53 is covered by the pad of the box test); leaf copies are rounded to nearest.
/// Deterministic: the same input gives the same bytes for every number of threads.
/// Throws Error (Stopped) when options.work.stop asks.
Tree build(const Primitives& primitives, const BuildOptions& options, Layout layout = Layout::Full);

/// Builds a tree whose leaves hold one number each, for a traversal that knows what they stand for.
/// Of each "triangle" only the box of its corners counts. Deterministic as `build` is.
Tree build_over_boxes(const Primitives& boxes, const WorkOptions& work);

/// Fits the boxes and leaf copies of a tree to the same primitives with moved corners, which must
/// lie in the same filter space. The structure stays, so queries slow down as neighbours part.
/// Deterministic; two to four times as fast as a build. Throws Error (Stopped) when asked to stop;
/// the tree is then of no use any more.
void refit(Tree& tree, const Primitives& primitives, const WorkOptions& work);

}  // namespace pierce::bvh
