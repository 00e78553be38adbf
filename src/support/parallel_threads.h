// SPDX-License-Identifier: Apache-2.0
//
// Parallel work by threads of our own (PIERCE_PARALLEL=threads); to be included by
// support/parallel.h.
//
// A process has one pool of workers, which start when there is work and sleep when there is none.
// Each with_threads is an arena: a queue of tasks that a limited number of threads serve. Whoever
// waits for a task serves its own arena meanwhile and no other, so that nothing foreign is ever run
// in the middle of a call. The child of a fork begins without a pool and makes its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>

namespace pierce::parallel {

std::size_t thread_count(unsigned threads);

namespace detail {

class Pool;

/// The second part of an invoke, until someone has run it. What changes is under the pool's lock.
struct Task {
  void (*call)(const void*);
  const void* function;
  Task* older = nullptr;  // neighbours in the queue
  Task* newer = nullptr;
  bool queued = false;
  bool done = false;
  bool awaited = false;  // by a thread that sleeps
  std::exception_ptr thrown = nullptr;
};

class Arena {
 public:
  explicit Arena(std::size_t limit);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// The arena that this thread is in, or null.
  static Arena* current();

  [[nodiscard]] bool is_serial() const { return limit_ == 1; }
  /// Lets others have the task.
  void offer(Task& task);
  /// Takes it back, if nobody has begun it.
  bool withdraw(Task& task);
  /// Waits until the task is done.
  void wait(Task& task);

 private:
  friend class Pool;

  const std::size_t limit_;
  Arena* const outer_;        // what the thread comes back to
  Pool* pool_ = nullptr;      // once there was a task
  std::size_t active_ = 1;    // threads in here
  std::size_t sleeping_ = 0;  // of these, how many wait
  Task* oldest_ = nullptr;
  Task* newest_ = nullptr;
  Arena* next_ = nullptr;  // in the pool's list
  std::condition_variable changed_;
};

template <class F, class G>
void invoke_in(Arena& arena, const F& f, const G& g) {
  if (arena.is_serial()) {
    f();
    g();
    return;
  }
  Task task{[](const void* function) { (*static_cast<const G*>(function))(); }, &g};
  arena.offer(task);
  try {
    f();
  } catch (...) {
    if (!arena.withdraw(task)) arena.wait(task);
    throw;
  }
  if (arena.withdraw(task)) {
    g();
    return;
  }
  arena.wait(task);
  if (task.thrown) std::rethrow_exception(task.thrown);
}

}  // namespace detail

template <class F>
auto with_threads(unsigned threads, const F& f) {
  const detail::Arena arena(thread_count(threads));
  return f();
}

template <class F, class G>
void invoke(const F& f, const G& g) {
  if (detail::Arena* arena = detail::Arena::current()) {
    detail::invoke_in(*arena, f, g);
  } else {
    detail::Arena own(thread_count(0));
    detail::invoke_in(own, f, g);
  }
}

}  // namespace pierce::parallel
