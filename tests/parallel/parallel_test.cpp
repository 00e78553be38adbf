// SPDX-License-Identifier: Apache-2.0
//
// What support/parallel.h promises, of the backend that this file is compiled for.
#include "support/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../support/rng.h"
#include "support/lock.h"

namespace pierce::parallel {
namespace {

// oneTBB promises no second thread, and gives none for a while after many callers at once.
#if defined(PIERCE_PARALLEL_THREADS)
constexpr bool kSurelyAtOnce = true;
#else
constexpr bool kSurelyAtOnce = false;
#endif

std::uint64_t sum_to(std::uint32_t count) {
  std::atomic<std::uint64_t> sum = 0;
  for_ranges(std::uint32_t{0}, count, 100, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t i = first; i != last; ++i) sum += i;
  });
  return sum;
}

TEST(Parallel, ranges_are_small_enough_and_cover_everything_once) {
  for (const std::size_t count : {0U, 1U, 2U, 7U, 64U, 65U, 1000U, 4097U}) {
    for (const std::size_t grain : {1U, 3U, 64U, 5000U}) {
      std::vector<int> seen(count, 0);
      for_ranges(std::size_t{0}, count, grain, [&](std::size_t first, std::size_t last) {
        EXPECT_LT(first, last);
        EXPECT_LE(last - first, grain);
        for (std::size_t i = first; i != last; ++i) ++seen[i];
      });
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST(Parallel, a_sum_of_rounded_numbers_is_the_same_for_every_number_of_threads) {
  std::vector<double> values(100001);
  hard::Rng rng(5, 0);
  for (double& x : values) x = rng.symmetric() * 1e10;
  const auto sum = [&](unsigned threads) {
    return with_threads(threads, [&] {
      return reduce(
          std::size_t{0}, values.size(), 64, 0.0,
          [&](std::size_t first, std::size_t last) {
            return std::accumulate(values.data() + first, values.data() + last, 0.0);
          },
          std::plus<double>());
    });
  };
  const double once = sum(1);
  for (int i = 0; i < 20; ++i) {
    for (const unsigned threads : {0U, 1U, 2U, 3U, 4U}) EXPECT_EQ(sum(threads), once);
  }
  EXPECT_EQ(reduce(
                0, 0, 1, 7, [](int, int) { return 1; }, std::plus<int>()),
            7);
}

TEST(Parallel, sorts_as_the_standard_library_does) {
  hard::Rng rng(6, 0);
  for (const std::size_t count : {0U, 1U, 8192U, 8193U, 30000U, 300001U}) {
    for (const std::uint32_t different : {1U, 100U, 0xffffffffU}) {
      std::vector<std::uint32_t> values(count), sorted;
      for (std::uint32_t& x : values) x = static_cast<std::uint32_t>(rng.below(different));
      sorted = values;
      std::sort(sorted.begin(), sorted.end());
      with_threads(4, [&] { parallel::sort(values.begin(), values.end(), std::less<>()); });
      EXPECT_EQ(values, sorted) << count << ' ' << different;
    }
  }
}

TEST(Parallel, parts_run_at_once_but_never_more_than_were_asked_for) {
  for (const unsigned threads : {1U, 2U, 3U, 4U}) {
    std::atomic<int> running = 0, most = 0;
    with_threads(threads, [&] {
      for_each(0, 64, [&](int) {
        const int now = ++running;
        for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --running;
      });
    });
    EXPECT_LE(most, static_cast<int>(thread_count(threads)));
    if (kSurelyAtOnce && thread_count(threads) > 1) {
      EXPECT_GE(most, 2);
    }
  }
}

TEST(Parallel, an_exception_of_either_part_arrives_when_both_are_done) {
  for (int i = 0; i < 200; ++i) {
    std::atomic<int> done = 0;
    const auto good = [&] { ++done; };
    const auto bad = [&] {
      ++done;
      throw std::runtime_error("thrown");
    };
    EXPECT_THROW(with_threads(4, [&] { invoke(good, bad); }), std::runtime_error);
    EXPECT_GE(done, 1);
    EXPECT_LE(done, 2);
    EXPECT_THROW(with_threads(4, [&] { invoke(bad, good); }), std::runtime_error);
    EXPECT_THROW(with_threads(4, [&] { invoke(bad, bad); }), std::runtime_error);
  }
  std::atomic<int> running = 0;
  EXPECT_THROW(with_threads(0,
                            [&] {
                              for_each(0, 1000, [&](int i) {
                                ++running;
                                if (i == 500) {
                                  --running;
                                  throw std::runtime_error("thrown");
                                }
                                --running;
                              });
                            }),
               std::runtime_error);
  EXPECT_EQ(running, 0);  // nothing goes on behind the caller's back
  EXPECT_EQ(sum_to(1000), 499500U);
}

TEST(Parallel, nests_within_itself_and_within_other_arenas) {
  std::atomic<std::uint64_t> sum = 0;
  with_threads(4, [&] {
    for_each(0, 40, [&](int i) {
      if (i % 2 == 0) {
        sum += sum_to(2000);
      } else {
        with_threads(static_cast<unsigned>(i) % 4, [&] { sum += sum_to(2000); });
      }
    });
  });
  EXPECT_EQ(sum, 40U * 1999000U);
}

TEST(Parallel, a_lock_may_be_held_around_an_arena_of_its_own) {
  // As the caller's progress function may ask a scene: nothing of the outer work is run there.
  Mutex mutex;
  std::uint64_t sum = 0;
  with_threads(4, [&] {
    for_each(0, 200, [&](int) {
      const Lock lock(mutex);
      sum += with_threads(2, [] { return sum_to(500); });
    });
  });
  EXPECT_EQ(sum, 200U * 124750U);
}

#if !defined(PIERCE_PARALLEL_SERIAL)

TEST(Parallel, serves_many_callers_at_once) {
  std::vector<std::thread> callers;
  std::atomic<int> right = 0;
  for (int i = 0; i < 8; ++i) {
    callers.emplace_back([&, i] {
      for (int j = 0; j < 50; ++j) {
        right += with_threads(static_cast<unsigned>(i) % 4, [] { return sum_to(3000); }) == 4498500;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(right, 400);
}

#if !defined(__SANITIZE_THREAD__)  // it allows no threads in the child of a process with threads

// Exit status of a child that does some parallel work, or -1 if it hangs.
int child_of_fork() {
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    bool right = true;
    for (unsigned threads = 0; threads < 5; ++threads) {
      right &= with_threads(threads, [] { return sum_to(5000); }) == 12497500;
    }
    _exit(right ? 0 : 1);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Parallel, the_child_of_a_fork_can_go_on) {
  EXPECT_EQ(with_threads(4, [] { return sum_to(5000); }), 12497500U);  // workers are there
  EXPECT_EQ(child_of_fork(), 0);
  EXPECT_EQ(with_threads(4, [] { return sum_to(5000); }), 12497500U);

  std::atomic<bool> stop = false;  // and while others are at work
  std::thread other([&] {
    while (!stop) with_threads(4, [] { return sum_to(2000); });
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(child_of_fork(), 0);
  stop = true;
  other.join();
}

#endif
#endif

}  // namespace
}  // namespace pierce::parallel
