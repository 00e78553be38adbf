// SPDX-License-Identifier: Apache-2.0
//
// Compiles the kernel for every instruction set, and chooses one at run time.
#include "kernels/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/wide.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target. Single lanes (a build without any
// of these sets) are not worth it: there is the plain kernel.
#if HWY_TARGET != HWY_SCALAR
#include "kernels/rays/block-inl.h"
#include "kernels/rays/blurred-inl.h"
#include "kernels/rays/decide_pair-inl.h"
#include "kernels/rays/single_queries-inl.h"
#include "kernels/rays/straight-inl.h"
#include "kernels/rays/transform-inl.h"
#include "kernels/rounding/round_one-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

template <class Real>
inline constexpr RealOps<Real> kRealOps = {transform_affine<Real>, round_columns<Real>,
                                           round_one<Real>, closest_mapped<Real>, any_mapped<Real>};

inline Kernel make_kernel(const char* name, AxisTraversal axis, NearestTraversal nearest,
                          WindingTraversal winding) {
  return {name,
          kRealOps<float>,
          kRealOps<double>,
          transform_scaled,
          rays_within,
          rays_mapped,
          round_copy,
          decide_pair,
          round_finely,
          round_in_place,
          round_unscaled,
          closest_scaled,
          any_scaled,
          closest,
          any,
          closest_block,
          any_block,
          all,
          {closest_blurred, any_blurred, all_blurred, visit_leaves, next_leaf,
           closest_blurred_block, any_blurred_block},
          axis,
          nearest,
          winding};
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // HWY_TARGET

#if HWY_ONCE

#include <hwy/targets.h>

#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/plain.h"
#include "pierce/error.h"

namespace pierce::kernels {
namespace {

struct Target {
  const char* name;
  std::int64_t set;
  Kernel (*make)(const char* name, AxisTraversal, NearestTraversal,
                 WindingTraversal);  // null: not in this build
};

#define PIERCE_TARGET(name, set) {name, HWY_##set, HWY_CHOOSE_##set(make_kernel)},
constexpr Target kTargets[] = {PIERCE_TARGETS(PIERCE_TARGET)};
#undef PIERCE_TARGET

// The kernels of this build that this machine runs, the best first.
std::vector<Kernel> supported_kernels() {
  std::vector<Kernel> kernels;
  for (std::size_t i = 0; i < std::size(kTargets); ++i) {
    const Target& target = kTargets[i];
    if (target.make == nullptr || (hwy::SupportedTargets() & target.set) == 0) continue;
    kernels.push_back(
        target.make(target.name, axis_traversal(i), nearest_traversal(i), winding_traversal(i)));
  }
  kernels.push_back(plain_kernel());
  return kernels;
}

const Kernel& chosen_kernel() {
  const char* wanted = std::getenv("PIERCE_KERNEL");
  if (wanted == nullptr || *wanted == '\0') return *kernels().front();
  std::string names;
  for (const Kernel* kernel : kernels()) {
    if (std::string_view(wanted) == kernel->name) return *kernel;
    names += (names.empty() ? "" : ", ") + std::string(kernel->name);
  }
  throw Error(ErrorCode::UnknownKernel, "PIERCE_KERNEL=" + std::string(wanted) +
                                            ": no such kernel on this machine; there are " + names);
}

}  // namespace

std::span<const Kernel* const> kernels() {
  static const std::vector<Kernel> kKernels = supported_kernels();
  static const std::vector<const Kernel*> kList = [] {
    std::vector<const Kernel*> list;
    for (const Kernel& kernel : kKernels) list.push_back(&kernel);
    return list;
  }();
  return kList;
}

const Kernel& active_kernel() { return chosen_kernel(); }

}  // namespace pierce::kernels

#endif  // HWY_ONCE
