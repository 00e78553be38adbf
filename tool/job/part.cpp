// SPDX-License-Identifier: Apache-2.0
#include "job/part.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "failure.h"

namespace pierce::tool {
namespace {

std::optional<std::uint64_t> to_whole(std::string_view text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || text.empty()) return {};
  return value;
}

std::optional<std::uint64_t> variable(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? std::nullopt : to_whole(text);
}

// A process of several that were started together. In a batch script SLURM_PROCID and SLURM_NTASKS
// are there as well, but only one process: it is srun that counts those of its step.
Part part_of_ranks() {
  struct Source {
    const char *rank, *size;
  };
  constexpr Source kSources[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                 {"PMI_RANK", "PMI_SIZE"},
                                 {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}};
  for (const auto& [rank, size] : kSources) {
    const auto i = variable(rank), of = variable(size);
    if (i && of && *of > 1 && *i < *of) return {*i, *of, rank};
  }
  return {};
}

// A job of a Slurm array, whose numbers need not begin with 0.
Part part_of_array() {
  const auto id = variable("SLURM_ARRAY_TASK_ID"), count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count || *count < 2) return {};
  const std::uint64_t first = variable("SLURM_ARRAY_TASK_MIN").value_or(0);
  const std::uint64_t step =
      std::max(variable("SLURM_ARRAY_TASK_STEP").value_or(1), std::uint64_t{1});
  const std::uint64_t i = *id < first ? *count : (*id - first) / step;
  if (i >= *count || (*id - first) % step != 0) {
    throw UsageError(
        fmt::format("SLURM_ARRAY_TASK_ID {} is not among {} numbers from {} in steps of {}: an "
                    "array with gaps does not tell which part this is; give --part i/n",
                    *id, *count, first, step));
  }
  return {i, *count, "SLURM_ARRAY_TASK_ID"};
}

}  // namespace

Part part_of_job(const std::string& option) {
  if (!option.empty()) {
    const std::size_t slash = option.find('/');
    const auto i = to_whole(option.substr(0, slash));
    const std::uint64_t of =
        to_whole(slash == std::string::npos ? "" : option.substr(slash + 1)).value_or(0);
    if (!i || *i >= of) {
      throw UsageError(
          fmt::format("--part: '{}' is not i/n, such as 0/4 and 3/4 (i from 0 to n - 1)", option));
    }
    return {*i, of, "--part"};
  }
  const Part array = part_of_array(), ranks = part_of_ranks();
  const char* const both = array.from.empty() || ranks.from.empty() ? "" : " and ";
  return {array.i * ranks.of + ranks.i, array.of * ranks.of, array.from + both + ranks.from};
}

}  // namespace pierce::tool
