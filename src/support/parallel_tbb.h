// SPDX-License-Identifier: Apache-2.0
//
// Parallel work by oneTBB (PIERCE_PARALLEL=tbb); to be included by support/parallel.h.
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

#include "support/float_environment.h"

namespace pierce::parallel {

namespace detail {

/// Whether this process was forked from one that had used oneTBB.
bool is_alone();

}  // namespace detail

/// Never more than oneTBB may start here: it would complain on stderr, and a library does not
/// print.
inline std::size_t thread_count(unsigned threads) {
  const std::size_t most =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return threads == 0 ? most : std::min<std::size_t>(threads, most);
}

template <class F>
auto with_threads(unsigned threads, const F& f) {
  if (detail::is_alone()) return f();
  return tbb::task_arena(static_cast<int>(thread_count(threads))).execute([&] {
    const FloatEnvironment environment;
    return f();
  });
}

template <class F, class G>
void invoke(const F& f, const G& g) {
  if (detail::is_alone()) {
    f();
    g();
    return;
  }
  // A thread of oneTBB has the floating-point mode of whoever came first.
  const auto run = [](const auto& part) {
    const FloatEnvironment environment;
    part();
  };
  tbb::parallel_invoke([&] { run(f); }, [&] { run(g); });
}

}  // namespace pierce::parallel
