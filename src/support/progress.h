// SPDX-License-Identifier: Apache-2.0
//
// How far work has come, told to the caller.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

#include "pierce/options.h"
#include "support/lock.h"

namespace pierce {

/// For part of the work: its 0 to 1 are `from` to `to` of the whole. Empty if `whole` is.
[[nodiscard]] inline Progress part_of(Progress whole, double from, double to) {
  if (!whole) return {};
  return [whole = std::move(whole), from, to](double fraction) {
    whole(from + fraction * (to - from));
  };
}

/// Counts what several threads have done, and reports it at most a few hundred times.
class ProgressMeter {
 public:
  explicit ProgressMeter(const Progress& progress) : progress_(progress) {}

  /// Begins a phase that takes the progress from `begin` to `end` in about `units` steps. Not
  /// while others advance.
  void phase(double begin, double end, std::uint64_t units) {
    begin_ = begin;
    width_ = end - begin;
    units_ = units;
    done_ = 0;
  }

  /// Some units of the phase are done; there may be more of them than were announced.
  void advance(std::uint64_t units) {
    if (!progress_ || units_ == 0) return;
    const std::uint64_t done = done_.fetch_add(units) + units;
    const double share = static_cast<double>(std::min(done, units_)) / static_cast<double>(units_);
    report(begin_ + width_ * share);
  }

  void report(double fraction) {
    if (!progress_) return;
    const parallel::Lock lock(mutex_);
    if (fraction < reported_ + 0.005 && fraction < 1) return;
    if (fraction <= reported_) return;
    reported_ = fraction;
    progress_(fraction);
  }

 private:
  const Progress& progress_;
  parallel::Mutex mutex_;
  double reported_ = -1;
  double begin_ = 0, width_ = 0;
  std::uint64_t units_ = 0;
  std::atomic<std::uint64_t> done_{0};
};

}  // namespace pierce
