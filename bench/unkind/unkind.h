// SPDX-License-Identifier: Apache-2.0
//
// `pierce bench --unkind`: every unkind scene beside its kind twin, pierce beside its peers.
// Answers are compared first; then all ways of both twins take turns, round by round. Processor
// time of one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "unkind/subject.h"

namespace pierce::bench {

struct UnkindOptions {
  std::vector<std::string> scenes;  ///< names; empty: all
  unsigned rounds = 5;
  Detail detail;
};

struct WayTiming {
  std::string way;            ///< one, batch, embree, cgal
  std::size_t questions = 0;  ///< that it answered
  std::size_t different = 0;  ///< of these, answered otherwise than by pierce
  std::vector<double> ns;     ///< of each round: a question, a hit (AllHits)
};

struct TwinResult {
  std::uint64_t triangles = 0;
  std::size_t questions = 0;
  std::vector<WayTiming> ways;

  /// The median; 0 if there is no such way.
  [[nodiscard]] double ns(const std::string& way) const;
};

struct UnkindRow {
  const UnkindScene* scene = nullptr;
  TwinResult unkind, kind;
};

/// Times over times: below 1 is good. 0 where there is nothing to compare with: a peer that answers
/// more than a tenth of the questions otherwise is none.
struct UnkindRatios {
  double one_peer = 0, batch_peer = 0;  ///< over the faster of Embree and CGAL
  double one_kind = 0, batch_kind = 0;  ///< over the same of the kind twin
  double batch_one = 0;                 ///< of the unkind scene

  [[nodiscard]] bool worse_than_peer() const;  ///< more than 2 times
  [[nodiscard]] bool worse_than_kind() const;  ///< more than 3 times
  [[nodiscard]] bool worse_than_loop() const;  ///< a batch more than 1.2 times
};
[[nodiscard]] UnkindRatios ratios_of(const UnkindRow& row);

/// `measured` is told of each row as soon as it is there; `step` before each part of the work, and
/// may throw to end the run. Throws Error (InvalidArgument) for a name that is not in the list,
/// std::runtime_error if pierce's batches answer otherwise than its singles.
std::vector<UnkindRow> run_unkind(const UnkindOptions& options, const std::function<void()>& step,
                                  const std::function<void(const UnkindRow&)>& measured);

[[nodiscard]] std::string unkind_header();
[[nodiscard]] std::string unkind_text(const UnkindRow& row);
/// Which rows are worse than they should be.
[[nodiscard]] std::string unkind_summary(const std::vector<UnkindRow>& rows);
[[nodiscard]] std::string unkind_list();
[[nodiscard]] std::string unkind_json(
    const std::vector<UnkindRow>& rows, const UnkindOptions& options,
    const std::vector<std::pair<std::string, std::string>>& machine);

}  // namespace pierce::bench
