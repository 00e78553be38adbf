// SPDX-License-Identifier: Apache-2.0
//
// In place of kernels/wide.cpp: the one kernel of this build.
#include "kernels/kernel.h"
#include "kernels/plain.h"

namespace pierce::kernels {

std::span<const Kernel* const> kernels() {
  static const Kernel kKernel = plain_kernel();
  static const Kernel* const kList[] = {&kKernel};
  return kList;
}

const Kernel& active_kernel() { return *kernels().front(); }

}  // namespace pierce::kernels
