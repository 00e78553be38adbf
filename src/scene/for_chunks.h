// SPDX-License-Identifier: Apache-2.0
//
// What all batches share: sizes checked, work cut into tasks, counts added up.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include "bvh/arena.h"
#include "pierce/error.h"
#include "pierce/options.h"
#include "scene/stop_poll.h"

namespace pierce::scene {

/// Rays a task: few enough to balance, many enough to pay for the hand-over.
inline constexpr std::size_t kRaysPerTask = 1024;

/// Throws Error (SizeMismatch) unless there is a result a point.
inline void validate_sizes(std::size_t points, std::size_t outputs) {
  if (points == outputs) return;
  throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(points) +
                                           " points but room for " + std::to_string(outputs) +
                                           " results; make the spans equally long");
}

/// Runs `work(begin, end)` over chunks of the rays on the wanted number of threads; polls stop and
/// reports progress between chunks.
template <class Work>
void for_chunks(std::size_t count, const BatchOptions& options, std::size_t grain,
                const Work& work) {
  std::mutex progress_mutex;
  std::size_t done = 0;
  const auto body = [&](const tbb::blocked_range<std::size_t>& chunk) {
    if (options.stop.stop_requested()) return;
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
