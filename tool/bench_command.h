// SPDX-License-Identifier: Apache-2.0
//
// pierce bench, where the benchmark was built (PIERCE_BUILD_BENCH).
#pragma once

#include "command.h"

namespace pierce::tool {

Command add_bench(CLI::App& app);

}  // namespace pierce::tool
