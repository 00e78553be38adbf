// SPDX-License-Identifier: Apache-2.0
//
// Which ratios the project has promised something about (or that say something by themselves).
#pragma once

#include <string>
#include <vector>

namespace pierce::bench {

struct Promise {
  std::string one, other;         ///< contenders: speed of `one` over that of `other`
  std::vector<std::string> sets;  ///< only these ray sets; empty: all
  double must, aim;               ///< of each cell, and (aim) of the geometric mean; 0: no promise
};

inline const std::vector<Promise>& promises() {
  static const std::vector<Promise> all{
      {"pierce", "embree", {}, 1.0, 1.4},
      {"pierce", "embree-robust", {}, 0, 0},
      {"pierce-batch", "embree-16", {"primary", "rows"}, 1.0, 1.3},
      {"pierce-batch", "embree", {"bounce", "random"}, 1.2, 2.0},
      {"pierce-batch", "embree", {"shadow"}, 0, 0},
      {"pierce", "embree4", {}, 0, 0},
      {"pierce-batch", "embree4", {}, 0, 0},
      {"pierce-high", "embree-high", {}, 0, 0},
      {"pierce-high", "embree4-high", {}, 0, 0},
      {"pierce-batch", "pierce", {}, 1.0, 0},
      {"pierce-batch-1", "pierce", {}, 0, 0},
      {"pierce-batch-16", "pierce", {}, 0.97, 0},
      {"pierce-batch-256", "pierce", {}, 1.0, 0},
      {"pierce-batch-4096", "pierce", {}, 1.0, 0},
      {"pierce-double", "pierce", {}, 0.7, 0.9},
      {"pierce-double-batch", "pierce-batch", {}, 0.7, 0.9},
      {"pierce-batch-all", "pierce-batch", {}, 0, 0},
      {"pierce-high", "pierce", {}, 0, 0},
      {"pierce-compact", "pierce", {}, 0, 0},
      {"pierce-compact-batch", "pierce-batch", {}, 0, 0},
      {"pierce-fast", "pierce", {}, 0, 0},
      {"pierce", "cgal", {}, 0, 0},
      {"pierce", "textbook", {}, 0, 0},
  };
  return all;
}

}  // namespace pierce::bench
