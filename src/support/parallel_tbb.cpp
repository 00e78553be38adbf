// SPDX-License-Identifier: Apache-2.0
//
// oneTBB and forks: its threads are not in the child, but its lists of them are.
#if defined(PIERCE_PARALLEL_TBB)

#include "support/parallel_tbb.h"

#include <atomic>

#if __has_include(<unistd.h>)
#include <pthread.h>
#endif

namespace pierce::parallel::detail {
namespace {

std::atomic<bool> used = false, alone = false;

#if __has_include(<unistd.h>)
struct AtFork {
  AtFork() {
    pthread_atfork(nullptr, nullptr, [] { alone = used.load(); });
  }
} at_fork;
#endif

}  // namespace

bool is_alone() {
  if (!used.load(std::memory_order_relaxed)) used = true;
  return alone.load(std::memory_order_relaxed);
}

}  // namespace pierce::parallel::detail

#endif
