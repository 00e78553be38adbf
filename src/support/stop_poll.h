// SPDX-License-Identifier: Apache-2.0
//
// Whether the caller wants a batch to stop: asked between rays, and now and then within one, whose
// list of hits may be long.
#pragma once

#include <atomic>
#include <cstdint>

#include "pierce/error.h"

namespace pierce::scene {

/// Of WorkOptions: whether somebody has asked the call to stop.
inline bool stop_wanted(const std::atomic<bool>* stop) {
  return stop != nullptr && stop->load(std::memory_order_relaxed);
}

class StopPoll {
 public:
  StopPoll() = default;  // never stops
  explicit StopPoll(const std::atomic<bool>* stop) : stop_(stop) {}

  /// Throws Error (Stopped) if the caller wants to stop.
  void now() const {
    if (stop_wanted(stop_)) [[unlikely]]
      throw Error(ErrorCode::Stopped, "stopped by the caller");
  }

  /// The same, once in a while: to be called wherever a microsecond or less has gone by.
  void sometimes() {
    if (++calls_ % 256 == 0) now();
  }

 private:
  const std::atomic<bool>* stop_ = nullptr;
  std::uint32_t calls_ = 0;
};

}  // namespace pierce::scene
