// SPDX-License-Identifier: Apache-2.0
//
// What a walk over all leaves has found. A triangle may lie in two leaves, and be found twice.
#pragma once

#include <algorithm>
#include <vector>

namespace pierce::scene {

/// Keeps each triangle once, in the order of their numbers (`primitive`).
template <class Found>
void once_each(std::vector<Found>& found) {
  const auto same = [](const Found& a, const Found& b) { return a.primitive == b.primitive; };
  std::ranges::sort(found, {}, &Found::primitive);
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
}

}  // namespace pierce::scene
