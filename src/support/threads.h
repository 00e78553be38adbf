// SPDX-License-Identifier: Apache-2.0
//
// How many threads a call of ours gets.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace pierce {

/// The number of threads that `threads` asks for, 0 meaning all. Never more than oneTBB may start
/// here: it would complain on stderr, and a library does not print.
inline std::size_t thread_count(unsigned threads) {
  const std::size_t most =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return threads == 0 ? most : std::min<std::size_t>(threads, most);
}

inline tbb::task_arena arena_for(unsigned threads) {
  return tbb::task_arena(static_cast<int>(thread_count(threads)));
}

}  // namespace pierce
