// SPDX-License-Identifier: Apache-2.0
//
// CGAL's ray-triangle predicate (exact predicates, inexact constructions) on our cases, already in
// its own types.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "micro/micro_cases.h"

namespace pierce::bench {

class CgalCases {
 public:
  explicit CgalCases(const std::vector<Case>& cases);
  ~CgalCases();
  CgalCases(const CgalCases&) = delete;
  CgalCases& operator=(const CgalCases&) = delete;

  [[nodiscard]] bool intersects(std::size_t i) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pierce::bench
