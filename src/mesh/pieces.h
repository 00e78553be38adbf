// SPDX-License-Identifier: Apache-2.0
//
// T-junctions: edges that have no partner of their own, but whose pieces have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pierce/types.h"
#include "support/stop_poll.h"

namespace pierce::mesh {

/// An edge that triangles do not use as often one way as the other.
struct LooseEdge {
  std::uint32_t from = 0, to = 0;  ///< vertices, each the first one at its position
  std::int64_t surplus = 0;        ///< how many more triangles run from `from` to `to` than back
};

enum class Pieces : std::uint8_t {
  Balanced,  ///< as many run one way as the other
  Even,      ///< their number is even; then `surplus` must be odd for every edge
};

/// Which edges would pair up if all were cut wherever another one of the same line ends: 1 or 0
/// an edge. Edges that hang together on a line count as one: all of them pair, or none.
///
/// Nothing is cut for it. Along a line, the sum of directed edges is a function that is constant
/// between ends, and 0 far out; it is 0 everywhere if and only if it changes at no end. So at each
/// vertex as many edges of each line through it must begin as end. The lines are told apart
/// exactly. Throws Error (Stopped).
template <class Real>
std::vector<std::uint8_t> pairs_in_pieces(std::span<const LooseEdge> edges,
                                          std::span<const Vec3<Real>> vertices, Pieces what,
                                          const scene::StopPoll& stop);

extern template std::vector<std::uint8_t> pairs_in_pieces(std::span<const LooseEdge>,
                                                          std::span<const Vec3<float>>, Pieces,
                                                          const scene::StopPoll&);
extern template std::vector<std::uint8_t> pairs_in_pieces(std::span<const LooseEdge>,
                                                          std::span<const Vec3<double>>, Pieces,
                                                          const scene::StopPoll&);

}  // namespace pierce::mesh
