// SPDX-License-Identifier: Apache-2.0
//
// Parallel work where there are no threads (PIERCE_PARALLEL=serial): one thing after the other; to
// be included by support/parallel.h.
#pragma once

#include <cstddef>

namespace pierce::parallel {

inline std::size_t thread_count(unsigned /*threads*/) { return 1; }

template <class F>
auto with_threads(unsigned /*threads*/, const F& f) {
  return f();
}

template <class F, class G>
void invoke(const F& f, const G& g) {
  f();
  g();
}

}  // namespace pierce::parallel
