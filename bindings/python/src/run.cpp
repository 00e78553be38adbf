// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace pierce::python {
namespace {

constexpr auto kPollEvery = std::chrono::milliseconds(40);

// The thread that works, and what it tells the one that waits.
class Worker {
 public:
  Worker(unsigned threads, bool tells, const std::function<void(const WorkOptions&)>& work)
      : thread_([this, threads, tells, &work] { run(threads, tells, work); }) {}
  ~Worker() {
    stop_ = true;
    thread_.join();
  }

  void stop() { stop_ = true; }
  [[nodiscard]] double fraction() const { return fraction_; }

  /// Waits a while, or to the end; true at the end.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPollEvery, [this] { return done_; });
  }
  void wait_to_the_end() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return done_; });
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  void run(unsigned threads, bool tells, const std::function<void(const WorkOptions&)>& work) {
    try {
      WorkOptions options{.threads = threads, .stop = &stop_};
      if (tells) options.progress = [this](double fraction) { fraction_ = fraction; };
      work(options);
    } catch (...) {
      thrown_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    done_ = true;
    changed_.notify_all();
  }

  std::atomic<bool> stop_ = false;
  std::atomic<double> fraction_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;  // the last to be made, as it uses the others
};

// The number of this process: another one after a fork.
long process() {
#if __has_include(<unistd.h>)
  return getpid();
#else
  return 0;
#endif
}

}  // namespace

void run(const Control& control, Length length,
         const std::function<void(const WorkOptions&)>& work) {
  const bool tells = !control.progress.is_none();
  if (length == Length::Brief && !tells) {
    const nb::gil_scoped_release released;
    work({.threads = control.threads});
    return;
  }
  const nb::gil_scoped_release released;
  const long here = process();
  auto worker = std::make_unique<Worker>(control.threads, tells, work);
  // A child that `progress` forked has no thread that works: to wait for it would have no end, and
  // to destroy what it used is not allowed.
  const auto forked = [&] {
    if (process() == here) return false;
    static_cast<void>(worker.release());
    return true;
  };
  double told = -1;
  for (bool done = false; !done;) {
    done = worker->wait();
    const nb::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      const double fraction = worker->fraction();
      if (tells && fraction != told) control.progress(told = fraction);
    } catch (...) {
      if (forked()) throw;
      const nb::gil_scoped_release released_again;
      worker->stop();
      worker->wait_to_the_end();
      throw;
    }
    if (forked()) {
      throw std::runtime_error(
          "this process was forked by progress(), and the call goes on in the parent alone; ask "
          "again here");
    }
  }
  worker->rethrow();
}

}  // namespace pierce::python
