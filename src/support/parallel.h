// SPDX-License-Identifier: Apache-2.0
//
// The one header through which the library uses threads. What runs at once is decided by
// PIERCE_PARALLEL (CMake): oneTBB, threads of our own, or nothing. All three offer the same three
// things (thread_count, with_threads, invoke); the algorithms here are made of these, and cut work
// by its size alone, so that every result is the same for each of them and any number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#if defined(PIERCE_PARALLEL_TBB)
#include "support/parallel_tbb.h"
#elif defined(PIERCE_PARALLEL_THREADS)
#include "support/parallel_threads.h"
#elif defined(PIERCE_PARALLEL_SERIAL)
#include "support/parallel_serial.h"
#else
#error "define PIERCE_PARALLEL_TBB, PIERCE_PARALLEL_THREADS or PIERCE_PARALLEL_SERIAL"
#endif

namespace pierce::parallel {

// Of the three backends:
//
// std::size_t thread_count(unsigned threads): how many threads a call that asks for `threads` gets,
//   0 meaning as many as the machine has.
// with_threads(unsigned threads, f): f(), whose parallel work takes at most so many threads.
// invoke(f, g): f() and g(), perhaps at once. Returns when neither is running; throws what one of
//   them has thrown, which may have kept the other from being begun. Whoever waits may run other
//   parts of the same with_threads meanwhile: so hold no lock around parallel work that its parts
//   take, too.
//
// The child of a fork may go on in parallel (threads), or goes on alone (oneTBB, whose threads are
// gone and would be waited for).

/// `body(first, last)` for ranges of at most `grain` (1 or more) that together are [begin, end).
template <class Index, class Body>
void for_ranges(Index begin, Index end, std::size_t grain, const Body& body) {
  if (begin == end) return;
  if (static_cast<std::size_t>(end - begin) <= grain) {
    body(begin, end);
    return;
  }
  const Index middle = begin + (end - begin) / 2;
  invoke([&] { for_ranges(begin, middle, grain, body); },
         [&] { for_ranges(middle, end, grain, body); });
}

/// `body(i)` for each i in [begin, end), each a task of its own.
template <class Index, class Body>
void for_each(Index begin, Index end, const Body& body) {
  for_ranges(begin, end, 1, [&](Index i, Index) { body(i); });
}

/// Values of ranges of at most `grain`, `body(first, last)`, joined by `join(left, right)` two by
/// two, always the same two. `empty` if there is nothing in [begin, end).
template <class Index, class Value, class Body, class Join>
Value reduce(Index begin, Index end, std::size_t grain, const Value& empty, const Body& body,
             const Join& join) {
  if (begin == end) return empty;
  if (static_cast<std::size_t>(end - begin) <= grain) return body(begin, end);
  const Index middle = begin + (end - begin) / 2;
  Value left = empty, right = empty;
  invoke([&] { left = reduce(begin, middle, grain, empty, body, join); },
         [&] { right = reduce(middle, end, grain, empty, body, join); });
  return join(left, right);
}

namespace detail {

inline constexpr std::ptrdiff_t kSortedBlock = 8192;  // not worth a task

/// Merges [a, a_end) and [b, b_end), both sorted, to `out`.
template <class It, class Out, class Less>
void merge_runs(It a, It a_end, It b, It b_end, Out out, const Less& less) {
  if (a_end - a < b_end - b) {
    // The longer one is cut in its middle, the other where that belongs.
    const It b_middle = b + (b_end - b) / 2;
    if (b_end - b <= kSortedBlock) {
      std::merge(std::make_move_iterator(a), std::make_move_iterator(a_end),
                 std::make_move_iterator(b), std::make_move_iterator(b_end), out, less);
      return;
    }
    const It a_middle = std::upper_bound(a, a_end, *b_middle, less);
    const Out middle = out + ((a_middle - a) + (b_middle - b));
    invoke([&] { merge_runs(a, a_middle, b, b_middle, out, less); },
           [&] { merge_runs(a_middle, a_end, b_middle, b_end, middle, less); });
    return;
  }
  if (a_end - a <= kSortedBlock) {
    std::merge(std::make_move_iterator(a), std::make_move_iterator(a_end),
               std::make_move_iterator(b), std::make_move_iterator(b_end), out, less);
    return;
  }
  const It a_middle = a + (a_end - a) / 2;
  const It b_middle = std::lower_bound(b, b_end, *a_middle, less);
  const Out middle = out + ((a_middle - a) + (b_middle - b));
  invoke([&] { merge_runs(a, a_middle, b, b_middle, out, less); },
         [&] { merge_runs(a_middle, a_end, b_middle, b_end, middle, less); });
}

/// Sorts `count` values at `from`, which end up there or, `to_scratch`, at `scratch`.
template <class It, class Scratch, class Less>
void merge_sort(It from, std::ptrdiff_t count, Scratch scratch, bool to_scratch, const Less& less) {
  if (count <= kSortedBlock) {
    std::sort(from, from + count, less);
    if (to_scratch) std::move(from, from + count, scratch);
    return;
  }
  const std::ptrdiff_t half = count / 2;
  invoke([&] { merge_sort(from, half, scratch, !to_scratch, less); },
         [&] { merge_sort(from + half, count - half, scratch + half, !to_scratch, less); });
  if (to_scratch) {
    merge_runs(from, from + half, from + half, from + count, scratch, less);
  } else {
    merge_runs(scratch, scratch + half, scratch + half, scratch + count, from, less);
  }
}

}  // namespace detail

/// Sorts as std::sort does, with memory for as many values again. Where `less` leaves two values
/// in no order, so does the sort.
template <class It, class Less>
void sort(It begin, It end, const Less& less) {
  if (end - begin <= detail::kSortedBlock) {
    std::sort(begin, end, less);
    return;
  }
  std::vector<typename std::iterator_traits<It>::value_type> scratch(
      static_cast<std::size_t>(end - begin));
  detail::merge_sort(begin, end - begin, scratch.begin(), false, less);
}

}  // namespace pierce::parallel
