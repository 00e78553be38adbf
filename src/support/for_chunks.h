// SPDX-License-Identifier: Apache-2.0
//
// What all batches share: work cut into tasks, counts added up.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <mutex>

#include "pierce/options.h"
#include "support/stop_poll.h"
#include "support/threads.h"

namespace pierce::scene {

/// Rays a task: few enough to balance, many enough to pay for the hand-over.
inline constexpr std::size_t kRaysPerTask = 1024;

/// Runs `work(begin, end)` over chunks of at most `grain` of `count` things on the wanted number of
/// threads; polls stop and reports progress between chunks.
template <class Work>
void for_chunks(std::size_t count, const WorkOptions& options, std::size_t grain,
                const Work& work) {
  std::mutex progress_mutex;
  std::size_t done = 0;
  const auto body = [&](const tbb::blocked_range<std::size_t>& chunk) {
    if (stop_wanted(options.stop)) return;
    work(chunk.begin(), chunk.end());
    if (!options.progress) return;
    const std::lock_guard lock(progress_mutex);
    done += chunk.size();
    options.progress(static_cast<double>(done) / static_cast<double>(count));
  };
  arena_for(options.threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), body,
                      tbb::simple_partitioner());
  });
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
    const std::lock_guard lock(mutex_);
    counts.add_to(*statistics_);
  }

 private:
  Statistics* statistics_;
  std::mutex mutex_;
};

}  // namespace pierce::scene
