// SPDX-License-Identifier: Apache-2.0
//
// The float rung, attacked where its bounds lie: what each attack is, and what they count.
//
// The promises (docs/algorithm.md): a box that a ray touches is entered, and not after the ray
// touches it; a triangle that is hit is never discarded; one that is not hit is never certain; and
// a certain one lies within the interval that is told of it. Each attack draws one case, decides it
// exactly, asks every instruction set, and says what is wrong, or nothing.
#pragma once

#include <string>

#include "bounds/draw.h"
#include "bounds/truth.h"

namespace pierce::siege {

struct Counts {
  std::uint64_t boxes = 0, touched = 0;            // a ray against a box of a node
  std::uint64_t triangles = 0, hit = 0;            // a ray against a triangle of a leaf
  std::uint64_t certain = 0;                       // of those, as the first instruction set says
  std::uint64_t in_blocks = 0, hit_in_blocks = 0;  // rays of a block against triangles below nodes

  [[nodiscard]] std::uint64_t tests() const { return boxes + triangles + in_blocks; }
};

/// One ray against the boxes of a node.
std::string attack_node(Rng& rng, Counts& counts);
/// One ray against the triangles of a leaf.
std::string attack_leaf(Rng& rng, Counts& counts);
/// The same through the public API: from far away, and into scenes that lie anywhere.
std::string attack_leaf_from_afar(Rng& rng, Counts& counts);
/// A block of rays against a node and its leaves, through every kernel and every traversal.
std::string attack_block(Rng& rng, Counts& counts);

/// The range in floats, as tight as it may be.
inline void set_tight_range(const RayD& ray, space::FilterRay& filter) {
  const auto limit = static_cast<double>(space::kTauLimit);
  const double first = std::clamp(ray.t_min, -limit, limit);
  const double last = std::clamp(ray.t_max, -limit, limit);
  filter.tau_min = exact::round_down(first);
  filter.tau_max = exact::round_up(last);
  filter.tau_first = exact::round_up(first);
  filter.tau_last = exact::round_down(last);
}

/// Ends the range near tau, at the start or at the end.
inline void end_near(Rng& rng, double tau, RayD& ray) {
  const double end = rng.coin() ? hard::nudged(tau, rng.between(-2, 2))
                                : tau + std::ldexp(rng.symmetric(), -rng.between(14, 52));
  const double clamped = std::clamp(attack::on_grid(end), -4.0, 4.0);
  (rng.coin() ? ray.t_min : ray.t_max) = std::isnan(clamped) ? 0 : clamped;
  ray.open_start = rng.one_in(4);
}

/// Every number of a ray and of triangles, for who looks into a failure.
std::string text_of(const RayD& ray, const std::vector<TriangleD>& triangles);

}  // namespace pierce::siege
