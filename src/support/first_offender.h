// SPDX-License-Identifier: Apache-2.0
//
// What several threads find wrong, named as one thread would: the first by number, and how many.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

namespace pierce::scene {

class FirstOffender {
 public:
  void note(std::uint64_t index) {
    ++count_;
    std::uint64_t known = first_;
    while (index < known && !first_.compare_exchange_weak(known, index)) {
    }
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// Of none: the greatest number.
  [[nodiscard]] std::uint64_t first() const { return first_; }

 private:
  std::atomic<std::uint64_t> first_ = std::numeric_limits<std::uint64_t>::max();
  std::atomic<std::uint64_t> count_ = 0;
};

}  // namespace pierce::scene
