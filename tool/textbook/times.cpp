// SPDX-License-Identifier: Apache-2.0
#include "textbook/times.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <type_traits>
#include <utility>

#include "pierce/intersect.h"

namespace pierce::tool {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kRounds = 5;
constexpr auto kTurn = std::chrono::milliseconds(3);

// Passes over the block for the length of a turn; remembers the fastest. The hits' t are added up,
// so that the compiler can leave no test out. Flattened, so that every method is inlined: returned
// from a call, an optional hit of floats goes through memory as it is written in four parts and
// read in two, which stalls for 8 ns (measured 2026-11) and says nothing about the method.
template <class Test>
[[gnu::flatten]] void take_turn(std::size_t count, const Test& test, double& best_ns) {
  const auto start = Clock::now();
  do {
    const auto begin = Clock::now();
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (const auto hit = test(i)) sum += static_cast<double>(hit->t);
    }
    const std::chrono::duration<double, std::nano> time = Clock::now() - begin;
    [[maybe_unused]] volatile double kept = sum;
    best_ns = std::min(best_ns, time.count() / static_cast<double>(count));
  } while (Clock::now() - start < kTurn);
}

template <class Real>
struct Block {
  const std::vector<Pair<Real>>& pairs;
  std::vector<textbook::NormalTriangle<Real>> normals;
  std::vector<textbook::AffineTriangle<Real>> maps;
  std::vector<textbook::ShearedRay<Real>> sheared;

  explicit Block(const std::vector<Pair<Real>>& the_pairs) : pairs(the_pairs) {
    for (const auto& [ray, a, b, c] : pairs) {
      normals.emplace_back(a, b, c);
      maps.emplace_back(a, b, c);
      sheared.emplace_back(ray);
    }
  }
};

// Method number `index` as a constant, so that it is inlined like a caller's own.
template <std::size_t index, class Real>
void take_turn_of(const Block<Real>& block, double& best_ns) {
  static constexpr textbook::Method<Real> method = textbook::methods<Real>()[index];
  take_turn(
      block.pairs.size(),
      [&block](std::size_t i) {
        const auto& [ray, a, b, c] = block.pairs[i];
        if constexpr (method.name == "precomputed_normal") {
          return textbook::precomputed_normal(ray, block.normals[i]);
        } else if constexpr (method.name == "baldwin_weber") {
          return textbook::baldwin_weber(ray, block.maps[i]);
        } else if constexpr (method.name == "watertight") {
          return textbook::watertight(block.sheared[i], a, b, c);
        } else {
          return method.test(ray, a, b, c);
        }
      },
      best_ns);
}

template <class Real, std::size_t... index>
void round_of_turns(const Block<Real>& block, std::vector<double>& ns,
                    std::index_sequence<index...>) {
  (take_turn_of<index>(block, ns[index]), ...);
  if constexpr (!std::is_same_v<Real, long double>) {
    take_turn(
        block.pairs.size(),
        [&block](std::size_t i) {
          const auto& [ray, a, b, c] = block.pairs[i];
          return intersect(ray, a, b, c);
        },
        ns.back());
  }
}

}  // namespace

template <class Real>
std::vector<double> ns_per_test(const std::vector<Pair<Real>>& pairs) {
  constexpr std::size_t kMethods = textbook::methods<Real>().size();
  const Block<Real> block(pairs);
  std::vector<double> ns(kMethods + (std::is_same_v<Real, long double> ? 0 : 1), 1e300);
  for (int round = 0; round < kRounds; ++round) {
    round_of_turns(block, ns, std::make_index_sequence<kMethods>());
  }
  return ns;
}

template std::vector<double> ns_per_test(const std::vector<Pair<float>>&);
template std::vector<double> ns_per_test(const std::vector<Pair<double>>&);
template std::vector<double> ns_per_test(const std::vector<Pair<long double>>&);

}  // namespace pierce::tool
