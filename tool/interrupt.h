// SPDX-License-Identifier: Apache-2.0
//
// Ctrl-C. A signal ends the program at once, unless work is under way that can stop by itself: then
// it asks that work to stop. A second signal ends it regardless. No half-written file is left in
// either case.
#pragma once

#include <atomic>

namespace pierce::tool::interrupt {

/// Call first thing in main, before any thread is made. Signals that the parent had ignored
/// (nohup) stay ignored. A closed pipe, or a file that reaches the limit of its size, becomes a
/// failed write instead of a signal.
void install();

/// For WorkOptions::stop.
[[nodiscard]] const std::atomic<bool>* stop();

/// Exit status of a stopped program: 128 + the signal's number.
[[nodiscard]] int exit_status();

/// Throws Error (Stopped) if a signal has come: for loops that no library call watches.
void check();

/// Ends the program here and now, from any thread; removes what was being written.
[[noreturn]] void end_at_once(int status);

/// While one of these lives, a signal requests a stop through stop() and no more.
class Graceful {
 public:
  Graceful();
  ~Graceful();
  Graceful(const Graceful&) = delete;
  Graceful& operator=(const Graceful&) = delete;
};

}  // namespace pierce::tool::interrupt
