// SPDX-License-Identifier: Apache-2.0
//
// What all batches share: work cut into tasks, counts added up.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pierce/options.h"
#include "support/lock.h"
#include "support/parallel.h"
#include "support/progress.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// Rays a task: few enough to balance, many enough to pay for the hand-over.
inline constexpr std::size_t kRaysPerTask = 1024;

/// Runs `work(begin, end)` over chunks of at most `grain` of `count` things on the wanted number of
/// threads; polls stop and reports progress between chunks.
template <class Work>
void for_chunks(std::size_t count, const WorkOptions& options, std::size_t grain,
                const Work& work) {
  ProgressMeter meter(options.progress);
  meter.phase(0, 1, count);
  const auto body = [&](std::size_t begin, std::size_t end) {
    if (stop_wanted(options.stop)) return;
    work(begin, end);
    meter.advance(end - begin);
  };
  if (count <= grain) {  // work for this thread alone
    if (count != 0) body(0, count);
  } else {
    parallel::with_threads(options.threads,
                           [&] { parallel::for_ranges(std::size_t{0}, count, grain, body); });
  }
  StopPoll(options.stop).now();
}

/// Per-chunk counts, added up under a lock when the chunk is done.
template <class Counts>
class CountSum {
 public:
  explicit CountSum(Statistics* statistics) : statistics_(statistics) {}
  [[nodiscard]] Counts start() const {
    Counts counts;
    counts.wanted = statistics_ != nullptr;
    return counts;
  }
  void add(const Counts& counts) {
    if (statistics_ == nullptr) return;
    const parallel::Lock lock(mutex_);
    counts.add_to(*statistics_);
  }

 private:
  Statistics* statistics_;
  parallel::Mutex mutex_;
};

}  // namespace pierce::scene
