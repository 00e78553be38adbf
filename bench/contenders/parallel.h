// SPDX-License-Identifier: Apache-2.0
//
// Threads for contenders that bring none of their own: chunks taken in turn by whoever is free.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace pierce::bench {

inline constexpr std::size_t kChunk = 4096;  // rays; a multiple of every packet

/// Calls work(begin, end) for all chunks of [0, count); with one thread, once and on this one.
template <class Work>
void in_chunks(std::size_t count, unsigned threads, const Work& work) {
  if (threads <= 1) {
    work(std::size_t{0}, count);
    return;
  }
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (;;) {
      const std::size_t begin = next.fetch_add(kChunk);
      if (begin >= count) return;
      work(begin, std::min(begin + kChunk, count));
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < threads; ++i) others.emplace_back(loop);
  loop();
}

}  // namespace pierce::bench
