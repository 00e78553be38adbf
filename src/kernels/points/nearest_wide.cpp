// SPDX-License-Identifier: Apache-2.0
//
// Compiles the traversal to the nearest triangle for every instruction set.
#include "kernels/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/points/nearest_wide.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target:
#include "kernels/points/nearest-inl.h"

#if HWY_ONCE

namespace pierce::kernels {

NearestTraversal nearest_traversal(std::size_t target) {
#define PIERCE_TRAVERSAL(name, set) HWY_CHOOSE_##set(nearest),
  static constexpr NearestTraversal kTraversals[] = {PIERCE_TARGETS(PIERCE_TRAVERSAL)};
#undef PIERCE_TRAVERSAL
  return kTraversals[target];
}

}  // namespace pierce::kernels

#endif  // HWY_ONCE
