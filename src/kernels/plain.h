// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/kernel.h"

namespace pierce::kernels {

/// The kernel without SIMD; runs anywhere. PIERCE_KERNEL=plain.
const Kernel& plain_kernel();

}  // namespace pierce::kernels
