// SPDX-License-Identifier: Apache-2.0
//
// How a build reports and how it is stopped: one object that all its threads share.
#pragma once

#include <cstdint>

#include "pierce/error.h"
#include "pierce/options.h"
#include "support/progress.h"

namespace pierce::bvh {

class BuildControl {
 public:
  explicit BuildControl(const WorkOptions& options) : options_(options), meter_(options.progress) {}

  /// Throws when the caller wants to stop. Cheap; called every few thousand primitives.
  void poll() const {
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
      throw Error(ErrorCode::Stopped, "the build of the search tree was stopped by the caller");
    }
  }

  /// Begins a phase that takes the progress from `begin` to `end` in about `units` steps. Where
  /// triangles are cut, or halves are uneven, there are more.
  void phase(double begin, double end, std::uint64_t units) {
    meter_.phase(begin, end, units);
    meter_.report(begin);
  }

  /// Some units of the phase are done.
  void advance(std::uint64_t units) {
    poll();
    meter_.advance(units);
  }

  void report(double fraction) { meter_.report(fraction); }

 private:
  const WorkOptions& options_;
  ProgressMeter meter_;
};

}  // namespace pierce::bvh
