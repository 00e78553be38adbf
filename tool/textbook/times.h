// SPDX-License-Identifier: Apache-2.0
//
// How long one test takes by each textbook method.
#pragma once

#include <cstddef>
#include <vector>

#include "pierce/textbook/methods.h"
#include "pierce/types.h"

namespace pierce::tool {

template <class Real>
struct Pair {
  Ray<Real> ray;
  Vec3<Real> a, b, c;
};

/// Nanoseconds a test over the block, for each of textbook::methods() and, for float and double,
/// pierce::intersect last. What a method keeps with a triangle or a ray is made beforehand. The
/// least of several passes that take turns with the other methods.
template <class Real>
[[nodiscard]] std::vector<double> ns_per_test(const std::vector<Pair<Real>>& block);

extern template std::vector<double> ns_per_test(const std::vector<Pair<float>>&);
extern template std::vector<double> ns_per_test(const std::vector<Pair<double>>&);
extern template std::vector<double> ns_per_test(const std::vector<Pair<long double>>&);

}  // namespace pierce::tool
