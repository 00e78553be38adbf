// SPDX-License-Identifier: Apache-2.0
//
// Random numbers for tests: the same on every machine and compiler (unlike std:: distributions).
// Every case of a test has its own generator made from (seed, index), so that a failing case is
// named by two numbers and cases can be spread over threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace pierce::hard {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t index = 0) : state_(mix(seed) ^ mix(~index)) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15u;
    return mix(state_);
  }

  /// Uniform in [0, n), n > 0 (the bias of 2^-64 n is of no concern here).
  std::uint64_t below(std::uint64_t n) { return bits() % n; }

  /// Uniform in [low, high], both included.
  int between(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint64_t>(high - low) + 1));
  }

  /// True once in n times.
  bool one_in(std::uint64_t n) { return below(n) == 0; }

  bool coin() { return one_in(2); }

  /// Uniform in [0, 1): a multiple of 2^-53.
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// Uniform in [-1, 1).
  double symmetric() { return 2 * unit() - 1; }

  /// Uniform in [-size, size).
  double within(double size) { return symmetric() * size; }

  /// One of a list that is not empty.
  template <class List>
  const auto& pick(const List& of) {
    return of[below(of.size())];
  }
  template <class T>
  T pick(std::initializer_list<T> of) {
    return of.begin()[below(of.size())];
  }

 private:
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace pierce::hard
