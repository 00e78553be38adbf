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
  /// f(), unless that has returned before; others wait for it.
  template <class F>
  void call(const F& f) {
    if (done_) return;
    f();
    done_ = true;
  }

 private:
  bool done_ = false;
};

}  // namespace pierce::parallel

#else

#include <mutex>

namespace pierce::parallel {

using Mutex = std::mutex;
using Lock = std::lock_guard<std::mutex>;

class Once {
 public:
  /// f(), unless that has returned before; others wait for it.
  template <class F>
  void call(const F& f) {
    std::call_once(flag_, f);
  }

 private:
  std::once_flag flag_;
};

}  // namespace pierce::parallel

#endif
