// SPDX-License-Identifier: Apache-2.0
//
// Are the answers right? Asked before anything is timed.
#pragma once

#include <cstdint>
#include <string>

#include "contenders/contender.h"

namespace pierce::bench {

/// How a contender's answers differ from the reference's.
struct Differences {
  std::uint64_t compared = 0;
  std::uint64_t missed = 0;          ///< the reference hits, the contender does not
  std::uint64_t invented = 0;        ///< the contender hits, the reference does not
  std::uint64_t other_triangle = 0;  ///< both hit, another triangle with another t
  std::uint64_t tied = 0;            ///< another triangle with the same rounded t: not wrong

  [[nodiscard]] std::uint64_t wrong() const { return missed + invented + other_triangle; }
};

/// Compares as the contender's kind demands; fewer answers than the set has rays are those of the
/// thinned set. Throws std::runtime_error that names the first
/// differing ray if an Exact or Double contender differs in anything at all.
Differences compare_answers(const Mesh& mesh, const RaySet& set, Query query,
                            const Answers& reference, const Contender& contender,
                            const Answers& answers);

}  // namespace pierce::bench
