// SPDX-License-Identifier: Apache-2.0
//
// How long something took.
#pragma once

#include <chrono>

namespace pierce::tool {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace pierce::tool
