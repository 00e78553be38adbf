// SPDX-License-Identifier: Apache-2.0
//
// The experiment: meshes x ray sets x queries x contenders. Answers are compared first; then all
// contenders of a cell take turns, round by round, in one process, so that whatever else the
// machine does meets them alike. Ratios are taken within a round.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contenders/contender.h"
#include "suite/compare.h"

namespace pierce::bench {

enum class Clock : std::uint8_t {
  Wall,
  Cpu,  ///< of the calling thread; only for contenders that run on one thread
};

struct SuiteOptions {
  std::vector<std::string> meshes;           ///< names of mesh_kinds()
  std::vector<std::filesystem::path> files;  ///< further meshes
  std::vector<std::string> sets;             ///< names of ray_kinds()
  std::vector<Query> queries{Query::Closest, Query::Any};
  std::vector<std::string> contenders;  ///< names of contender_kinds()
  unsigned rounds = 5;
  unsigned build_rounds = 1;
  unsigned threads = 1;        ///< of the queries
  unsigned build_threads = 0;  ///< 0: as many as the machine has
  unsigned side = 1024;        ///< a set has side x side rays
  Clock clock = Clock::Wall;
};

struct BuildResult {
  std::string engine;
  std::vector<double> seconds;
  std::uint64_t bytes = 0;
  double sah_cost = 0;
};

struct Timing {
  std::string contender;
  unsigned threads = 1;
  std::size_t rays = 0;
  std::vector<double> seconds;  ///< one per round
  Differences differences;
  /// Rays per second of round r.
  [[nodiscard]] double speed(std::size_t r) const { return static_cast<double>(rays) / seconds[r]; }
  [[nodiscard]] std::vector<double> speeds() const;
};

struct Cell {
  std::string set;
  Query query;
  std::size_t rays = 0;
  std::uint64_t hits = 0;  ///< rays that hit, by the reference
  std::optional<Statistics> ladder;
  std::vector<Timing> timings;

  [[nodiscard]] const Timing* find(const std::string& contender) const;
};

struct MeshResult {
  std::string mesh;
  std::uint64_t triangles = 0, vertices = 0;
  std::vector<BuildResult> builds;
  std::vector<Cell> cells;
};

struct SuiteResult {
  SuiteOptions options;
  std::vector<MeshResult> meshes;
};

/// Told of what has been done, as soon as it is, and of each step before it is taken: an exception
/// thrown from there ends the run.
struct SuiteListener {
  std::function<void(const std::string& step)> step = [](const std::string&) {};
  std::function<void(const MeshResult&)> built = [](const MeshResult&) {};
  std::function<void(const MeshResult&, const Cell&)> measured = [](const MeshResult&,
                                                                    const Cell&) {};
};

/// Throws Error for bad names, std::runtime_error when pierce's own answers differ.
SuiteResult run_suite(const SuiteOptions& options, const SuiteListener& listener);

/// Per round, the speed of `one` over that of `other`.
[[nodiscard]] std::vector<double> paired_ratios(const Timing& one, const Timing& other);

}  // namespace pierce::bench
