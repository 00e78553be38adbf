// SPDX-License-Identifier: Apache-2.0
//
// How a build reports and how it is stopped: one object that all its threads share.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>

#include "pierce/error.h"
#include "pierce/options.h"

namespace pierce::bvh {

class BuildControl {
 public:
  explicit BuildControl(const WorkOptions& options) : options_(options) {}

  /// Throws when the caller wants to stop. Cheap; called every few thousand primitives.
  void poll() const {
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
      throw Error(ErrorCode::Stopped, "the build of the search tree was stopped by the caller");
    }
  }

  /// Begins a phase that takes the progress from `begin` to `end` in about `units` steps.
  void phase(double begin, double end, std::uint64_t units) {
    begin_ = begin;
    width_ = end - begin;
    units_ = units;
    done_ = 0;
    report(begin);
  }

  /// Some units of the phase are done. Reports at most a few hundred times a build.
  void advance(std::uint64_t units) {
    poll();
    if (!options_.progress || units_ == 0) return;
    const std::uint64_t done = done_.fetch_add(units) + units;
    // Where triangles are cut, or halves are uneven, there are more steps than units.
    const double share = static_cast<double>(std::min(done, units_)) / static_cast<double>(units_);
    report(begin_ + width_ * share);
  }

  void report(double fraction) {
    if (!options_.progress) return;
    const std::lock_guard lock(mutex_);
    if (fraction < reported_ + 0.005 && fraction < 1) return;
    if (fraction <= reported_) return;
    reported_ = fraction;
    options_.progress(fraction);
  }

 private:
  const WorkOptions& options_;
  std::mutex mutex_;
  double reported_ = -1;
  double begin_ = 0, width_ = 0;
  std::uint64_t units_ = 0;
  std::atomic<std::uint64_t> done_{0};
};

}  // namespace pierce::bvh
