// SPDX-License-Identifier: Apache-2.0
//
// How many cases a test looks at, and which. Three environment variables, all optional:
//   PIERCE_CASES=10000000   cases of each long test (the default is what ctest should take)
//   PIERCE_SEED=7           another set of cases
//   PIERCE_TEST_THREADS=2   threads to spread them over
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace pierce::hard {

inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::stoull(text);
}

inline std::uint64_t seed() {
  static const std::uint64_t value = from_environment("PIERCE_SEED", 1);
  return value;
}

inline std::uint64_t case_count(std::uint64_t otherwise) {
  return from_environment("PIERCE_CASES", otherwise);
}

/// Whether these are at least as many as ctest takes: enough to expect that each kind is met.
inline bool enough_cases(std::uint64_t otherwise) { return case_count(otherwise) >= otherwise; }

/// Calls fails(index) for 0 <= index < count on all cores and returns the smallest index of a chunk
/// for which it returned true; stops early then.
template <class Fails>
std::optional<std::uint64_t> first_failure(std::uint64_t count, Fails fails) {
  constexpr std::uint64_t kChunk = 256;
  std::atomic<std::uint64_t> next = 0, failure = count;
  const auto work = [&] {
    for (;;) {
      const std::uint64_t begin = next.fetch_add(kChunk);
      if (begin >= failure) return;
      for (std::uint64_t i = begin; i < std::min(begin + kChunk, count); ++i) {
        if (!fails(i)) continue;
        std::uint64_t known = failure;
        while (i < known && !failure.compare_exchange_weak(known, i)) {
        }
        return;
      }
    }
  };
  const auto threads =
      from_environment("PIERCE_TEST_THREADS", std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::thread> pool;
  for (std::uint64_t i = 1; i < threads; ++i) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  return failure < count ? std::optional<std::uint64_t>(failure) : std::nullopt;
}

}  // namespace pierce::hard
