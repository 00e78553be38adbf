// SPDX-License-Identifier: Apache-2.0
//
// campaign --seed S [--first N] [--cases N] [--seconds T] [--save FOLDER]
// campaign --replay FILE
//
// Asks the library about hard cases, one after the other, and compares every answer with rational
// arithmetic. Prints a line for each difference, then how many cases of each kind and answers of
// each query there were. Exit status: 0 all agree, 1 differences, 2 usage, 3 no such kernel.
// scripts/campaign.py runs it over all kernels.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "campaign/check.h"

namespace pierce::campaign {
namespace {

struct Arguments {
  std::uint64_t seed = 1, first = 0, cases = ~std::uint64_t{0};
  double seconds = 0;
  std::string save, replay;
};

/// What the handler of a crash says: which case it was.
char now[128];

void say_which(int signal) {
  if (write(STDERR_FILENO, now, std::strlen(now)) < 0) _exit(128 + signal);
  std::signal(signal, SIG_DFL);
  raise(signal);
}

bool parse(int count, char** words, Arguments& arguments) {
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = words[i], value = words[i + 1];
    if (name == "--seed")
      arguments.seed = std::stoull(value);
    else if (name == "--first")
      arguments.first = std::stoull(value);
    else if (name == "--cases")
      arguments.cases = std::stoull(value);
    else if (name == "--seconds")
      arguments.seconds = std::stod(value);
    else if (name == "--save")
      arguments.save = value;
    else if (name == "--replay")
      arguments.replay = value;
    else
      return false;
  }
  return count % 2 == 1 && count > 1;
}

/// Counts the words of the case's name, which say of what shape it is, and where.
void count_words(const AnyCase& made, std::map<std::string, std::uint64_t>& kinds) {
  std::string name = std::visit([](const auto& one) { return one.name; }, made);
  for (;;) {
    const std::size_t end = name.find(", ");
    ++kinds[name.substr(0, end)];
    if (end == std::string::npos) return;
    name.erase(0, end + 2);
  }
}

/// Prints the differences of a case, a few of many; true if there are any.
bool report(Tally& tally, const std::string& which) {
  const auto differences = tally.take_differences();
  for (std::size_t i = 0; i < differences.size() && i < 5; ++i) {
    std::cout << "difference " << which << ": " << differences[i] << '\n';
  }
  if (differences.size() > 5) std::cout << "... of " << differences.size() << '\n';
  std::cout.flush();
  return !differences.empty();
}

int replay(const std::string& file) {
  std::ifstream in(file);
  Tally tally;
  check(load_case(in), tally);
  return report(tally, file) ? 1 : 0;
}

void save(const std::string& folder, const Arguments& arguments, std::uint64_t number,
          const AnyCase& made) {
  if (folder.empty()) return;
  const std::string file =
      folder + "/case-" + std::to_string(arguments.seed) + "-" + std::to_string(number) + ".txt";
  std::filesystem::create_directories(folder);
  std::ofstream out(file);
  save_case(out, made);
  std::cout << "saved " << file << '\n';
}

int run(const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(arguments.seconds);
  Tally tally;
  std::map<std::string, std::uint64_t> kinds;
  std::uint64_t differing = 0, number = arguments.first;
  for (std::uint64_t done = 0; done < arguments.cases; ++done, ++number) {
    if (arguments.seconds > 0 && Clock::now() >= end) break;
    std::snprintf(now, sizeof now, "campaign: crashed at --seed %llu --first %llu --cases 1\n",
                  static_cast<unsigned long long>(arguments.seed),
                  static_cast<unsigned long long>(number));
    const AnyCase made = make_case(arguments.seed, number);
    check(made, tally);
    count_words(made, kinds);
    if (!report(tally, "in case " + std::to_string(number))) continue;
    ++differing;
    save(arguments.save, arguments, number, made);
  }
  for (const auto& [kind, count] : kinds) std::cout << "kind " << count << ' ' << kind << '\n';
  for (const auto& [query, count] : tally.counts()) {
    std::cout << "query " << count << ' ' << query << '\n';
  }
  std::cout << "processor " << static_cast<double>(std::clock()) / CLOCKS_PER_SEC << "\ncases "
            << number - arguments.first << " differing " << differing << '\n';
  return differing == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pierce::campaign

int main(int count, char** words) {
  using namespace pierce;
  campaign::Arguments arguments;
  try {
    if (!campaign::parse(count, words, arguments)) {
      std::cerr
          << "usage: campaign --seed S [--first N] [--cases N] [--seconds T] [--save FOLDER]\n"
             "       campaign --replay FILE\n";
      return 2;
    }
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) {
      std::signal(signal, campaign::say_which);
    }
    const auto nothing =
        Scene<float>::build(MeshView<float>{});  // throws if there is no such kernel
    if (nothing.any_hit({{0, 0, 0}, {0, 0, 1}})) return 1;
    return arguments.replay.empty() ? campaign::run(arguments) : campaign::replay(arguments.replay);
  } catch (const Error& error) {
    std::cerr << "campaign: " << error.what() << '\n';
    return error.code() == ErrorCode::UnknownKernel ? 3 : 2;
  } catch (const std::exception& error) {
    std::cerr << "campaign: " << error.what() << '\n';
    return 2;
  }
}
