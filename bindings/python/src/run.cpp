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
#include <utility>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace pierce::python {
namespace {

constexpr auto kPollEvery = std::chrono::milliseconds(40);

using Work = std::function<void(const WorkOptions&)>;

// A thread that works while another one waits, at one job after the other: to start a thread takes
// as long as a thousand rays.
class Worker {
 public:
  Worker() : thread_([this] { serve(); }) {}
  /// Not while it works.
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    begun_.notify_one();
    thread_.join();
  }

  /// `work` must live until the end. Not while it works at something else.
  void start(unsigned threads, bool tells, const Work& work) {
    {
      const std::lock_guard lock(mutex_);
      stop_ = false;
      fraction_ = 0;
      thrown_ = nullptr;
      threads_ = threads;
      tells_ = tells;
      work_ = &work;
    }
    begun_.notify_one();
  }
  void stop() { stop_ = true; }
  [[nodiscard]] double fraction() const { return fraction_; }

  /// Waits a while, or to the end; true at the end.
  bool wait() {
    std::unique_lock lock(mutex_);
    return done_.wait_for(lock, kPollEvery, [this] { return work_ == nullptr; });
  }
  void wait_to_the_end() {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return work_ == nullptr; });
  }
  /// At the end.
  void rethrow() {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }

 private:
  void serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      begun_.wait(lock, [this] { return work_ != nullptr || ends_; });
      if (work_ == nullptr) return;
      lock.unlock();
      std::exception_ptr thrown;
      try {
        WorkOptions options{.threads = threads_, .stop = &stop_};
        if (tells_) options.progress = [this](double fraction) { fraction_ = fraction; };
        (*work_)(options);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      thrown_ = std::move(thrown);
      work_ = nullptr;
      done_.notify_one();
    }
  }

  std::atomic<bool> stop_ = false;
  std::atomic<double> fraction_ = 0;
  std::mutex mutex_;
  std::condition_variable begun_, done_;
  unsigned threads_ = 0;
  bool tells_ = false, ends_ = false;
  const Work* work_ = nullptr;  // until it is done
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

// A worker for one call. Each thread that calls keeps one for its next call; those of calls within
// calls are made anew.
class HiredWorker {
 public:
  HiredWorker() : here_(process()) {
    Idle& idle = idle_worker();
    idle.forget_another_process();
    worker_ = idle.worker != nullptr ? std::move(idle.worker) : std::make_unique<Worker>();
  }
  ~HiredWorker() {
    if (forked()) {
      static_cast<void>(worker_.release());
    } else if (Idle& idle = idle_worker(); idle.worker == nullptr) {
      idle = {std::move(worker_), here_};
    }
  }
  HiredWorker(const HiredWorker&) = delete;
  HiredWorker& operator=(const HiredWorker&) = delete;
  Worker* operator->() const { return worker_.get(); }

  /// Whether this is the child of a fork since: it has no thread that works. To wait for that would
  /// have no end, and to destroy what it used is not allowed.
  [[nodiscard]] bool forked() const { return process() != here_; }

 private:
  struct Idle {
    std::unique_ptr<Worker> worker;
    long made_in = 0;  // a process

    Idle& operator=(Idle&&) = default;
    ~Idle() { forget_another_process(); }
    void forget_another_process() {
      if (made_in != process()) static_cast<void>(worker.release());
    }
  };
  static Idle& idle_worker() {
    static thread_local Idle idle;
    return idle;
  }

  std::unique_ptr<Worker> worker_;
  long here_;
};

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
  const HiredWorker worker;
  worker->start(control.threads, tells, work);
  double told = -1;
  for (bool done = false; !done;) {
    done = worker->wait();
    const nb::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      const double fraction = worker->fraction();
      if (tells && fraction != told) control.progress(told = fraction);
    } catch (...) {
      if (worker.forked()) throw;
      const nb::gil_scoped_release released_again;
      worker->stop();
      worker->wait_to_the_end();
      throw;
    }
    if (worker.forked()) {
      throw std::runtime_error(
          "this process was forked by progress(), and the call goes on in the parent alone; ask "
          "again here");
    }
  }
  worker->rethrow();
}

}  // namespace pierce::python
