// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pierce::predicate {

/// How often each rung had the last word.
struct LadderCounts {
  std::uint64_t certified = 0;
  std::uint64_t settled = 0;
  std::uint64_t settled_big = 0;
  std::uint64_t orders_certified = 0;
  std::uint64_t orders_settled = 0;
  std::uint64_t rounded_exactly = 0;
};

}  // namespace pierce::predicate
