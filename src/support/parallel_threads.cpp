// SPDX-License-Identifier: Apache-2.0
//
// The pool of PIERCE_PARALLEL=threads. One lock for everything: tasks are large (a thousand rays),
// so it is taken some ten thousand times a second.
#if defined(PIERCE_PARALLEL_THREADS)

#include "support/parallel_threads.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "support/float_environment.h"

#if __has_include(<unistd.h>)
#include <pthread.h>
#endif

namespace pierce::parallel {
namespace {

std::size_t hardware_threads() {
  return std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

// Who asks for a few threads gets them, also on a machine that has fewer.
constexpr std::size_t kAlwaysGranted = 4;

std::size_t most_threads() { return std::max(kAlwaysGranted, hardware_threads()); }

}  // namespace

std::size_t thread_count(unsigned threads) {
  return threads == 0 ? hardware_threads() : std::min<std::size_t>(threads, most_threads());
}

namespace detail {
namespace {

thread_local Arena* current_arena = nullptr;

}  // namespace

class Pool {
 public:
  static Pool& instance();

  void offer(Arena& arena, Task& task) {
    const std::lock_guard lock(mutex_);
    if (arena.oldest_ == nullptr) list(arena);
    task.queued = true;
    task.older = arena.newest_;
    (arena.newest_ != nullptr ? arena.newest_->newer : arena.oldest_) = &task;
    arena.newest_ = &task;
    call_for_help(arena);
  }

  bool withdraw(Arena& arena, Task& task) {
    const std::lock_guard lock(mutex_);
    if (!task.queued) return false;
    remove(arena, task);
    return true;
  }

  void wait(Arena& arena, Task& task) {
    std::unique_lock lock(mutex_);
    while (!task.done) {
      if (arena.oldest_ != nullptr) {
        run_oldest(arena, lock);
      } else {
        task.awaited = true;
        ++arena.sleeping_;
        arena.changed_.wait(lock);
        --arena.sleeping_;
      }
    }
  }

  void stop() {
    std::vector<std::thread> workers;
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      workers.swap(workers_);
      work_.notify_all();
    }
    for (std::thread& worker : workers) worker.join();
  }

 private:
  // Of arenas only those with tasks are in the list.
  void list(Arena& arena) {
    arena.next_ = arenas_;
    arenas_ = &arena;
  }
  void unlist(const Arena& arena) {
    Arena** place = &arenas_;
    while (*place != &arena) place = &(*place)->next_;
    *place = arena.next_;
  }

  void remove(Arena& arena, Task& task) {
    (task.older != nullptr ? task.older->newer : arena.oldest_) = task.newer;
    (task.newer != nullptr ? task.newer->older : arena.newest_) = task.older;
    task.queued = false;
    if (arena.oldest_ == nullptr) unlist(arena);
  }

  // There is a task, and perhaps a thread for it.
  void call_for_help(Arena& arena) {
    if (arena.sleeping_ != 0) arena.changed_.notify_one();
    if (arena.active_ >= arena.limit_) return;
    if (idle_ != 0) {
      work_.notify_one();
    } else {
      start_worker();
    }
  }

  void run_oldest(Arena& arena, std::unique_lock<std::mutex>& lock) {
    Task& task = *arena.oldest_;
    remove(arena, task);
    // Calls that came while this thread was waking up have gone unheard.
    if (arena.oldest_ != nullptr) call_for_help(arena);
    lock.unlock();
    try {
      task.call(task.function);
    } catch (...) {
      task.thrown = std::current_exception();
    }
    lock.lock();
    task.done = true;
    if (task.awaited) arena.changed_.notify_all();
  }

  Arena* find_work() const {
    Arena* arena = arenas_;
    while (arena != nullptr && arena->active_ >= arena->limit_) arena = arena->next_;
    return arena;
  }

  // Where no more threads are to be had, those that are there do the work.
  void start_worker() {
    if (stopping_ || workers_.size() + 1 >= most_threads()) return;
    try {
      workers_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
    }
  }

  void serve() {
    const FloatEnvironment environment;
    std::unique_lock lock(mutex_);
    while (!stopping_) {
      Arena* const arena = find_work();
      if (arena == nullptr) {
        ++idle_;
        work_.wait(lock);
        --idle_;
        continue;
      }
      ++arena->active_;
      current_arena = arena;
      // The arena is there as long as one of its tasks is not done, and is left before the lock is.
      while (arena->oldest_ != nullptr) run_oldest(*arena, lock);
      --arena->active_;
      current_arena = nullptr;
    }
  }

  std::mutex mutex_;
  std::condition_variable work_;
  std::vector<std::thread> workers_;
  std::size_t idle_ = 0;
  bool stopping_ = false;
  Arena* arenas_ = nullptr;
};

namespace {

std::atomic<Pool*> the_pool = nullptr;

// Workers end with the process, or with the shared library. The pool itself stays: somebody may
// still wait in it.
struct AtExit {
  AtExit() {
#if __has_include(<unistd.h>)
    // A child has no workers, and a lock that someone may have held for ever.
    pthread_atfork(nullptr, nullptr, [] { the_pool = nullptr; });
#endif
  }
  ~AtExit() {
    if (Pool* pool = the_pool) pool->stop();
  }
} at_exit;

}  // namespace

Pool& Pool::instance() {
  Pool* pool = the_pool;
  if (pool == nullptr) {
    auto* const made = new Pool;
    if (the_pool.compare_exchange_strong(pool, made)) {
      pool = made;
    } else {
      delete made;
    }
  }
  return *pool;
}

Arena::Arena(std::size_t limit) : limit_(limit), outer_(current_arena) { current_arena = this; }
Arena::~Arena() { current_arena = outer_; }
Arena* Arena::current() { return current_arena; }

void Arena::offer(Task& task) {
  if (pool_ == nullptr) pool_ = &Pool::instance();
  pool_->offer(*this, task);
}
bool Arena::withdraw(Task& task) { return pool_->withdraw(*this, task); }
void Arena::wait(Task& task) { pool_->wait(*this, task); }

}  // namespace detail
}  // namespace pierce::parallel

#endif
