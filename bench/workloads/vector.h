// SPDX-License-Identifier: Apache-2.0
//
// The little that making workloads takes beyond the public vector algebra; nothing exact about it.
#pragma once

#include <cmath>

#include "pierce/types.h"
#include "pierce/vector.h"

namespace pierce::bench {

using Double3 = Vec3<double>;

inline double length(const Double3& a) { return std::sqrt(dot(a, a)); }
inline Double3 normalized(const Double3& a) { return (1 / length(a)) * a; }

template <class Real>
Double3 to_double(const Vec3<Real>& a) {
  return convert<double>(a);
}
inline Vec3<float> to_float(const Double3& a) { return convert<float>(a); }

}  // namespace pierce::bench
