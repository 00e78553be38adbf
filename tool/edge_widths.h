// SPDX-License-Identifier: Apache-2.0
//
// How wide the cracks and holes are that open edges border.
#pragma once

#include <span>
#include <vector>

#include "pierce/closed.h"
#include "pierce/types.h"

namespace pierce::tool {

/// For each edge: how far its middle is from the nearest other one, in double. Not counted is the
/// very vertex at which another edge goes on; so along a crack it is the distance to the other
/// side, 0 at a T-junction, and in a hole the distance across. Infinity if there is no other.
template <class Real>
[[nodiscard]] std::vector<double> edge_widths(MeshView<Real> mesh, std::span<const EdgeUse> edges);

extern template std::vector<double> edge_widths(MeshView<float>, std::span<const EdgeUse>);
extern template std::vector<double> edge_widths(MeshView<double>, std::span<const EdgeUse>);

/// Of all of them together.
struct WidthSummary {
  double narrowest = 0, median = 0, widest = 0;  ///< of those that are finite
  std::size_t widest_edge = 0;
  std::uint64_t zero = 0, finite = 0;
};
[[nodiscard]] WidthSummary summary_of(std::span<const double> widths);

}  // namespace pierce::tool
