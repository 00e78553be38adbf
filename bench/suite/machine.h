// SPDX-License-Identifier: Apache-2.0
//
// Where and with what a measurement was made: without it a figure says nothing.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pierce::bench {

/// Names and values, ready to print: cpu, caches, memory, system, load, compiler, flags, kernel,
/// commit, versions of the peers, date (UTC).
[[nodiscard]] std::vector<std::pair<std::string, std::string>> describe_machine();

}  // namespace pierce::bench
