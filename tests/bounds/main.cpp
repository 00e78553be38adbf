// SPDX-License-Identifier: Apache-2.0
//
// bounds_attack [--tests N] [--seed S] [--first CASE]
//
// Attacks the box test, the leaf cull and the traversals of every kernel of this machine with N (or
// a few more) tests at their bounds, one ray against one box or triangle each, and prints what they
// were. Exit status: 0 nothing found, 1 a promise broken (the case is printed and named, so that
// --first runs it again), 2 usage.
#include <chrono>
#include <iostream>
#include <string>

#include "bounds/siege.h"
#include "bounds/targets.h"

namespace pierce::siege {
namespace {

struct Arguments {
  std::uint64_t tests = 500000, seed = 1, first = 0;
};

bool parse(int count, char** words, Arguments& arguments) {
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = words[i];
    std::uint64_t& to = name == "--tests"  ? arguments.tests
                        : name == "--seed" ? arguments.seed
                                           : arguments.first;
    if (name != "--tests" && name != "--seed" && name != "--first") return false;
    to = std::stoull(words[i + 1]);
  }
  return count % 2 == 1;
}

/// Each attack about as many tests as the next.
std::string attack(std::uint64_t seed, std::uint64_t number, Counts& counts) {
  Rng rng(seed, number);
  const std::uint64_t kind = number % 32;
  if (kind == 0) return attack_block(rng, counts);
  if (kind == 1) return attack_leaf_from_afar(rng, counts);
  return kind % 2 == 0 ? attack_node(rng, counts) : attack_leaf(rng, counts);
}

void report(const Counts& c, std::uint64_t cases, double seconds) {
  std::cout << "boxes      " << c.boxes << ", touched " << c.touched << "\ntriangles  "
            << c.triangles << ", hit " << c.hit << ", certain " << c.certain << "\nin blocks  "
            << c.in_blocks << ", hit " << c.hit_in_blocks << "\ntests      " << c.tests() << " in "
            << cases << " cases, on";
  for (const Target& target : targets()) std::cout << ' ' << target.name;
  std::cout << " (in blocks also on plain), " << seconds << " s\n";
}

int run(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  Counts counts;
  std::uint64_t number = arguments.first;
  for (; counts.tests() < arguments.tests; ++number) {
    const std::string wrong = attack(arguments.seed, number, counts);
    if (wrong.empty()) continue;
    std::cout << "broken by --seed " << arguments.seed << " --first " << number << " --tests 1\n"
              << wrong;
    return 1;
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  report(counts, number - arguments.first, time.count());
  return 0;
}

}  // namespace
}  // namespace pierce::siege

int main(int count, char** words) {
  pierce::siege::Arguments arguments;
  try {
    if (!pierce::siege::parse(count, words, arguments)) {
      std::cerr << "usage: bounds_attack [--tests N] [--seed S] [--first CASE]\n";
      return 2;
    }
  } catch (const std::exception&) {
    std::cerr << "bounds_attack: what follows an option is a whole number\n";
    return 2;
  }
  return pierce::siege::run(arguments);
}
