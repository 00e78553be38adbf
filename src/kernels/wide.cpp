// SPDX-License-Identifier: Apache-2.0
//
// Compiles the wide kernel for every instruction set, and picks one.
// Of the sets that Highway knows on x86, those that differ for us: SSE4, AVX2 and AVX-512.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/wide.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target. Single lanes (a build without any
// of these sets) are not worth it: there is the plain kernel.
#if HWY_TARGET != HWY_SCALAR
#include "kernels/rays/block-inl.h"
#include "kernels/rays/transform-inl.h"
#include "kernels/rounding/round_one-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

inline Kernel make_kernel(const char* name) {
  return {name,
          transform_scaled,
          transform_affine<float>,
          transform_affine<double>,
          rays_within<float>,
          rays_within<double>,
          closest,
          any,
          closest_block,
          any_block,
          all,
          round_columns<float>,
          round_columns<double>,
          round_pair<float>,
          round_pair<double>,
          round_copy};
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // HWY_TARGET

#if HWY_ONCE

#include <hwy/targets.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "kernels/plain.h"
#include "pierce/error.h"

namespace pierce::kernels {
namespace {

// The wide kernels of this build that this machine runs, the widest first.
std::vector<const Kernel*> supported_kernels() {
  const std::int64_t supported = hwy::SupportedTargets();
  std::vector<const Kernel*> list;
  [[maybe_unused]] const auto add = [&](std::int64_t target, const Kernel& kernel) {
    if ((supported & target) != 0) list.push_back(&kernel);
  };
#if HWY_TARGETS & HWY_AVX3
  static const Kernel kAvx512 = N_AVX3::make_kernel("avx512");
  add(HWY_AVX3, kAvx512);
#endif
#if HWY_TARGETS & HWY_AVX2
  static const Kernel kAvx2 = N_AVX2::make_kernel("avx2");
  add(HWY_AVX2, kAvx2);
#endif
#if HWY_TARGETS & HWY_SSE4
  static const Kernel kSse4 = N_SSE4::make_kernel("sse4");
  add(HWY_SSE4, kSse4);
#endif
#if HWY_TARGETS & HWY_NEON
  static const Kernel kNeon = N_NEON::make_kernel("neon");
  add(HWY_NEON, kNeon);
#endif
#if HWY_TARGETS & HWY_WASM
  static const Kernel kWasm = N_WASM::make_kernel("wasm");
  add(HWY_WASM, kWasm);
#endif
  list.push_back(&plain_kernel());
  return list;
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
  static const std::vector<const Kernel*> kList = supported_kernels();
  return kList;
}

const Kernel& active_kernel() { return chosen_kernel(); }

}  // namespace pierce::kernels

#endif  // HWY_ONCE
