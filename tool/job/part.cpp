// SPDX-License-Identifier: Apache-2.0
#include "job/part.h"

#include <fmt/format.h>

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

// A rank and how many there are; of a Slurm array the first need not be 0.
struct Source {
  const char *index, *count, *first;
};
constexpr Source kSources[] = {
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
    {"PMI_RANK", "PMI_SIZE", nullptr},
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
    {"SLURM_PROCID", "SLURM_NTASKS", nullptr}};

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
  for (const auto& [index, count, first] : kSources) {
    const auto i = variable(index), of = variable(count);
    const std::uint64_t from = first == nullptr ? 0 : variable(first).value_or(0);
    if (i && of && *of > 1 && *i >= from && *i - from < *of) return {*i - from, *of, index};
  }
  return {};
}

}  // namespace pierce::tool
