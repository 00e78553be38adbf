// SPDX-License-Identifier: Apache-2.0
//
// Compiles the sum of solid angles for every instruction set.
#include "kernels/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/points/winding_wide.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target:
#include "kernels/points/winding-inl.h"

#if HWY_ONCE

namespace pierce::kernels {

WindingTraversal winding_traversal(std::size_t target) {
#define PIERCE_TRAVERSAL(name, set) HWY_CHOOSE_##set(sum_winding),
  static constexpr WindingTraversal kTraversals[] = {PIERCE_TARGETS(PIERCE_TRAVERSAL)};
#undef PIERCE_TRAVERSAL
  return kTraversals[target];
}

}  // namespace pierce::kernels

#endif  // HWY_ONCE
