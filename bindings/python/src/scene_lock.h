// SPDX-License-Identifier: Apache-2.0
//
// Many ask a scene, or one changes it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

namespace pierce::python {

/// While somebody wishes to own, nobody begins to share: a scene that is asked all the time can
/// still be changed.
class SceneLock {
 public:
  using Time = std::chrono::milliseconds;

  /// False if it cannot be had in that time. `again`: this thread shares it already, and must not
  /// wait for somebody who waits for it.
  bool share_within(Time time, bool again) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, time, [&] { return !owned_ && (again || wishing_ == 0); })) {
      return false;
    }
    ++sharing_;
    return true;
  }
  /// Which process this is, counted in forks: what was begun before a fork has no end after it.
  [[nodiscard]] unsigned forks() const { return forks_; }
  void end_sharing(unsigned forks) {
    const std::lock_guard lock(mutex_);
    if (forks == forks_ && --sharing_ == 0) changed_.notify_all();
  }

  void wish_to_own() {
    const std::lock_guard lock(mutex_);
    ++wishing_;
  }
  void end_wishing() {
    const std::lock_guard lock(mutex_);
    if (--wishing_ == 0) changed_.notify_all();
  }
  /// False if it cannot be had in that time; for who wishes it.
  bool own_within(Time time) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, time, [&] { return !owned_ && sharing_ == 0; })) return false;
    return owned_ = true;
  }
  void end_owning(unsigned forks) {
    const std::lock_guard lock(mutex_);
    if (forks == forks_) owned_ = false;
    changed_.notify_all();
  }

  /// For a child that was forked, before anything else happens there: the threads that shared or
  /// owned are not in it. True if one owned. Nothing is destroyed, as destroying waits for them.
  bool forget_threads() {
    const bool owned = owned_;
    const unsigned forks = forks_ + 1;
    std::construct_at(this);
    forks_ = forks;
    return owned;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  unsigned sharing_ = 0, wishing_ = 0, forks_ = 0;
  bool owned_ = false;
};

}  // namespace pierce::python
