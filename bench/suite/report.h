// SPDX-License-Identifier: Apache-2.0
//
// What was measured, as text for people and as JSON for scripts/performance_page.py.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "suite/suite.h"

namespace pierce::bench {

using MachineLines = std::vector<std::pair<std::string, std::string>>;

/// One line a built engine: Mtri/s, bytes per triangle, SAH cost.
[[nodiscard]] std::string builds_text(const MeshResult& mesh);

/// One line a cell: millions of rays per second of each contender, medians of the rounds.
[[nodiscard]] std::string cells_header(const MeshResult& mesh, const SuiteOptions& options);
[[nodiscard]] std::string cell_text(const Cell& cell);

/// What each contender got wrong in the cell; empty if nothing.
[[nodiscard]] std::string differences_text(const Cell& cell);

/// The ratios that matter, median of the rounds: each cell, the least and the geometric mean.
[[nodiscard]] std::string ratios_text(const SuiteResult& result);

/// What each rung of the ladder saw, summed over the cells of each mesh.
[[nodiscard]] std::string ladder_text(const SuiteResult& result);

[[nodiscard]] std::string to_json(const SuiteResult& result, const MachineLines& machine);

}  // namespace pierce::bench
