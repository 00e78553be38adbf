// SPDX-License-Identifier: Apache-2.0
//
// Mutual exclusion, which is nothing where there are no threads (PIERCE_PARALLEL=serial).
#pragma once

#if defined(PIERCE_PARALLEL_SERIAL)

namespace pierce::parallel {

struct Mutex {};

class Lock {
 public:
  explicit Lock(Mutex& /*mutex*/) {}
  ~Lock() {}  // not trivial: a lock is not an unused variable
};

class Once {
 public:
  /// f(), unless that has returned before. Others wait for it, and call `poll` meanwhile, which may
  /// throw.
  template <class F, class Poll>
  void call(const F& f, const Poll& /*poll*/) {
    if (done_) return;
    f();
    done_ = true;
  }

 private:
  bool done_ = false;
};

}  // namespace pierce::parallel

#else

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace pierce::parallel {

using Mutex = std::mutex;
using Lock = std::lock_guard<std::mutex>;

class Once {
 public:
  /// f(), unless that has returned before. Others wait for it, and call `poll` meanwhile, which may
  /// throw.
  template <class F, class Poll>
  void call(const F& f, const Poll& poll) {
    if (done_.load(std::memory_order_acquire)) return;
    std::unique_lock lock(running_, std::try_to_lock);
    while (!lock.owns_lock()) {
      poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      (void)lock.try_lock();
    }
    if (done_.load(std::memory_order_relaxed)) return;
    f();
    done_.store(true, std::memory_order_release);
  }

 private:
  std::mutex running_;
  std::atomic<bool> done_ = false;
};

}  // namespace pierce::parallel

#endif
