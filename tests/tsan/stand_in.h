// SPDX-License-Identifier: Apache-2.0
//
// Stands in for oneTBB in a thread-sanitizer build (cmake/pierce_tsan.cmake).
//
// The sanitizer cannot see into the distribution's libtbb, so it takes every hand-over of a task
// for a race; and a suppression wide enough to silence that would silence our own races too. Here
// each algorithm that pierce uses forks and joins plain std::threads, which the sanitizer knows.
// The threads are real and the pieces as small as oneTBB's; only the scheduling is simpler.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <iterator>
#include <thread>
#include <utility>

namespace tbb {

template <class T>
class blocked_range {
 public:
  blocked_range(T begin, T end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  [[nodiscard]] T begin() const { return begin_; }
  [[nodiscard]] T end() const { return end_; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  [[nodiscard]] bool empty() const { return !(begin_ < end_); }
  [[nodiscard]] std::size_t grainsize() const { return grain_; }
  [[nodiscard]] bool is_divisible() const { return grain_ < size(); }
  [[nodiscard]] std::pair<blocked_range, blocked_range> halves() const {
    const T middle = begin_ + (end_ - begin_) / 2;
    return {{begin_, middle, grain_}, {middle, end_, grain_}};
  }

 private:
  T begin_, end_;
  std::size_t grain_;
};

namespace stand_in {

inline constexpr int kThreads = 4;
inline std::atomic<int> spare{kThreads - 1};  // threads that may still be started
inline thread_local int limit = kThreads;     // of the arena we are in; 1 is serial

// Runs both, the second on a thread of its own if one is to be had.
template <class F, class G>
void fork(const F& f, const G& g) {
  if (limit == 1 || spare.fetch_sub(1) <= 0) {
    if (limit != 1) spare.fetch_add(1);
    f();
    g();
    return;
  }
  std::exception_ptr from_g, from_f;
  std::thread thread([&, inherited = limit] {
    limit = inherited;
    try {
      g();
    } catch (...) {
      from_g = std::current_exception();
    }
  });
  try {
    f();
  } catch (...) {
    from_f = std::current_exception();
  }
  thread.join();
  spare.fetch_add(1);
  if (from_f) std::rethrow_exception(from_f);
  if (from_g) std::rethrow_exception(from_g);
}

}  // namespace stand_in

struct simple_partitioner {};
struct auto_partitioner {};
struct static_partitioner {};

template <class F, class G>
void parallel_invoke(const F& f, const G& g) {
  stand_in::fork(f, g);
}

template <class T, class Body, class Partitioner = auto_partitioner>
void parallel_for(const blocked_range<T>& range, const Body& body, const Partitioner& how = {}) {
  if (range.empty()) return;
  if (!range.is_divisible()) return body(range);
  const auto [left, right] = range.halves();
  stand_in::fork([&, &l = left] { parallel_for(l, body, how); },
                 [&, &r = right] { parallel_for(r, body, how); });
}

template <class Index, class Body>
void parallel_for(Index begin, Index end, const Body& body) {
  // Some pieces a thread, as oneTBB does it: starting a thread is dear.
  const std::size_t grain = end > begin ? static_cast<std::size_t>(end - begin) / 16 + 1 : 1;
  parallel_for(blocked_range<Index>(begin, end, grain), [&](const blocked_range<Index>& range) {
    for (Index i = range.begin(); i < range.end(); ++i) body(i);
  });
}

template <class T, class Value, class Body, class Join>
Value parallel_reduce(const blocked_range<T>& range, const Value& identity, const Body& body,
                      const Join& join) {
  if (!range.is_divisible()) return range.empty() ? identity : body(range, identity);
  const auto [left, right] = range.halves();
  Value a = identity, b = identity;
  stand_in::fork([&, &l = left] { a = parallel_reduce(l, identity, body, join); },
                 [&, &r = right] { b = parallel_reduce(r, identity, body, join); });
  return join(a, b);
}

// Ranges are split the same way every time, so this one is deterministic as it is.
template <class T, class Value, class Body, class Join>
Value parallel_deterministic_reduce(const blocked_range<T>& range, const Value& identity,
                                    const Body& body, const Join& join) {
  return parallel_reduce(range, identity, body, join);
}

template <class Iterator, class Less>
void parallel_sort(Iterator begin, Iterator end, const Less& less) {
  if (end - begin < 2048) return std::sort(begin, end, less);
  const Iterator middle = std::next(begin, (end - begin) / 2);
  stand_in::fork([&] { parallel_sort(begin, middle, less); },
                 [&] { parallel_sort(middle, end, less); });
  std::inplace_merge(begin, middle, end, less);
}

template <class Iterator>
void parallel_sort(Iterator begin, Iterator end) {
  parallel_sort(begin, end, std::less<>{});
}

class task_arena {
 public:
  static constexpr int automatic = -1;
  explicit task_arena(int threads = automatic) : threads_(threads) {}
  template <class F>
  auto execute(const F& f) {
    const Restore restore{stand_in::limit};
    stand_in::limit = threads_ == automatic ? stand_in::kThreads : threads_;
    return f();
  }

 private:
  struct Restore {
    int before;
    ~Restore() { stand_in::limit = before; }
  };
  int threads_;
};

namespace this_task_arena {
inline int max_concurrency() { return stand_in::limit; }
}  // namespace this_task_arena

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  static std::size_t active_value(parameter) { return stand_in::kThreads; }
};

}  // namespace tbb
