// SPDX-License-Identifier: Apache-2.0
//
// A line on the terminal that shows how far long work has come; nothing if stderr is no terminal.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "pierce/options.h"

namespace pierce::tool {

/// Erases itself when destroyed. Appears only after a moment, so that quick work shows nothing.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction);
  /// What stands behind the time left: how fast it goes, say.
  void note(std::string text) { note_ = std::move(text); }

  /// For the options of the library, which report 0 to 1; see part_of. Empty if nothing would be
  /// shown. Must not outlive the bar.
  [[nodiscard]] Progress callback(double from = 0, double to = 1);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_, note_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point begin_, next_;
};

}  // namespace pierce::tool
