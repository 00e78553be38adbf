// SPDX-License-Identifier: Apache-2.0
//
// Robust statistics of a handful of timings.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pierce::bench {

/// The value below which the fraction q of the samples lies, linearly between neighbours; 0 if
/// there are none.
inline double quantile(std::vector<double> samples, double q) {
  if (samples.empty()) return 0;
  std::sort(samples.begin(), samples.end());
  const double place = q * static_cast<double>(samples.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, samples.size() - 1);
  const double part = place - static_cast<double>(below);
  return samples[below] + part * (samples[above] - samples[below]);
}

inline double median(const std::vector<double>& samples) { return quantile(samples, 0.5); }

}  // namespace pierce::bench
