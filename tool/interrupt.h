// SPDX-License-Identifier: Apache-2.0
//
// Ctrl-C. A signal ends the program at once, unless work is under way that has something to clean
// up (a half-written file): then it asks that work to stop. A second signal ends it regardless.
#pragma once

#include <stop_token>

namespace pierce::tool::interrupt {

/// Call first thing in main, before any thread is made. Signals that the parent had ignored
/// (nohup) stay ignored. A closed pipe becomes a failed write instead of a signal.
void install();

/// For BuildOptions::stop and BatchOptions::stop.
[[nodiscard]] std::stop_token token();

/// Exit status of a stopped program: 128 + the signal's number.
[[nodiscard]] int exit_status();

/// Throws Error (Stopped) if a signal has come: for loops that no library call watches.
void check();

/// While one of these lives, a signal requests a stop through token() and no more.
class Graceful {
 public:
  Graceful();
  ~Graceful();
  Graceful(const Graceful&) = delete;
  Graceful& operator=(const Graceful&) = delete;
};

}  // namespace pierce::tool::interrupt
