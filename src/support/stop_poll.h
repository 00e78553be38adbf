// SPDX-License-Identifier: Apache-2.0
//
// Whether the caller wants a batch to stop: asked between rays, and now and then within one, whose
// list of hits may be long.
#pragma once

#include <cstdint>
#include <stop_token>
#include <utility>

#include "pierce/error.h"

namespace pierce::scene {

class StopPoll {
 public:
  StopPoll() = default;  // never stops
  explicit StopPoll(std::stop_token stop) : stop_(std::move(stop)) {}

  /// Throws Error (Stopped) if the caller wants to stop.
  void now() const {
    if (stop_.stop_requested()) [[unlikely]]
      throw Error(ErrorCode::Stopped, "stopped by the caller");
  }

  /// The same, once in a while: to be called wherever a microsecond or less has gone by.
  void sometimes() {
    if (++calls_ % 256 == 0) now();
  }

 private:
  std::stop_token stop_;
  std::uint32_t calls_ = 0;
};

}  // namespace pierce::scene
