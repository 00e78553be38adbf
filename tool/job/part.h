// SPDX-License-Identifier: Apache-2.0
//
// Which chunks of a job a worker casts.
#pragma once

#include <cstdint>
#include <string>

namespace pierce::tool {

/// Chunks i, i + of, i + 2 of, ...
struct Part {
  std::uint64_t i = 0, of = 1;
  std::string from;  ///< who says so, for people: nothing if it is all
};

/// "i/n", i from 0 to n - 1. Empty: what Open MPI, MPICH or Slurm (srun, an array, srun in an
/// array) have told this process by its environment, else all. Throws UsageError.
[[nodiscard]] Part part_of_job(const std::string& option);

}  // namespace pierce::tool
