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

#include "pierce/error.h"

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace pierce::python {
namespace {

constexpr auto kPollEvery = std::chrono::milliseconds(40);

using Task = std::function<void(const WorkOptions&)>;

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
  void start(unsigned threads, bool tells, Work kind, const Task& work) {
    {
      const std::lock_guard lock(mutex_);
      stop_ = false;
      needs_leave_ = kind == Work::Changes;
      asks_leave_ = false;
      fraction_ = 0;
      thrown_ = nullptr;
      threads_ = threads;
      tells_ = tells || needs_leave_;
      work_ = &work;
    }
    begun_.notify_one();
  }
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    left_.notify_all();
  }
  [[nodiscard]] double fraction() const { return fraction_; }

  enum class State : std::uint8_t { Works, AsksLeave, Done };
  /// Waits a while, or until it has something to say.
  State wait() {
    std::unique_lock lock(mutex_);
    done_.wait_for(lock, kPollEvery, [this] { return work_ == nullptr || asks_leave_; });
    return work_ == nullptr ? State::Done : asks_leave_ ? State::AsksLeave : State::Works;
  }
  /// To change what it is about to change.
  void give_leave() {
    {
      const std::lock_guard lock(mutex_);
      needs_leave_ = asks_leave_ = false;
    }
    left_.notify_all();
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
        if (tells_) options.progress = [this](double fraction) { tell(fraction); };
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

  void tell(double fraction) {
    fraction_ = fraction;
    if (fraction < 1) return;
    std::unique_lock lock(mutex_);
    if (!needs_leave_) return;
    asks_leave_ = true;
    done_.notify_one();
    left_.wait(lock, [this] { return !needs_leave_ || stop_; });
    asks_leave_ = false;
    if (needs_leave_) throw Error(ErrorCode::Stopped, "the call was ended before its last step");
  }

  std::atomic<bool> stop_ = false;
  std::atomic<double> fraction_ = 0;
  std::mutex mutex_;
  std::condition_variable begun_, left_, done_;
  unsigned threads_ = 0;
  bool tells_ = false, ends_ = false, needs_leave_ = false, asks_leave_ = false;
  const Task* work_ = nullptr;  // until it is done
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

void run(const Control& control, Length length, const std::function<void(const WorkOptions&)>& work,
         Work kind) {
  using State = Worker::State;
  const bool tells = !control.progress.is_none();
  const nb::gil_scoped_release released;
  if (length == Length::Brief && !tells) {
    work({.threads = control.threads});
    return;
  }
  const HiredWorker worker;
  worker->start(control.threads, tells, kind, work);
  double told = -1;
  for (State state = State::Works; state == State::Works;) {
    state = worker->wait();
    if (state == State::Done && kind == Work::Changes) break;  // too late to end it
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
    if (state == State::AsksLeave) worker->give_leave();
  }
  worker->wait_to_the_end();
  worker->rethrow();
}

}  // namespace pierce::python
