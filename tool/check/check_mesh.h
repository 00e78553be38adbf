// SPDX-License-Identifier: Apache-2.0
//
// One scene, many hard rays: every query of the scene against the oracle, bit by bit.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pierce/scene.h"

namespace pierce::tool {

struct CheckOptions {
  std::uint64_t rays = 10000;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

struct CheckResult {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;         ///< over all rays: of the oracle's lists
  std::uint64_t on_edge = 0;      ///< of these, with u, v or w exactly 0
  std::uint64_t differences = 0;  ///< answers that are not the oracle's
  std::string first;              ///< the first of them, several lines; empty if there is none
  Statistics statistics;
  double seconds = 0;
};

/// Asks the scene over the meshes for closest_hit, any_hit, all_hits and crossings, single and
/// batch, closed and open at the start of the range. `name` labels the progress bar and the first
/// difference.
template <class Real>
[[nodiscard]] CheckResult check_mesh(const std::string& name,
                                     std::span<const MeshView<Real>> meshes,
                                     const Scene<Real>& scene, const CheckOptions& options);

extern template CheckResult check_mesh(const std::string&, std::span<const MeshView<float>>,
                                       const Scene<float>&, const CheckOptions&);
extern template CheckResult check_mesh(const std::string&, std::span<const MeshView<double>>,
                                       const Scene<double>&, const CheckOptions&);

}  // namespace pierce::tool
