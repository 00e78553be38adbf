// SPDX-License-Identifier: Apache-2.0
//
// Cases and hits as text: hex floats, in the form of C++ initializers, ready to be pasted into a
// regression test. And equality to the bit, which knows -0 from +0.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <string>
#include <type_traits>

#include "pierce/types.h"
#include "support/hard_cases.h"

namespace pierce::show {

template <class Real>
std::string text(Real x) {
  constexpr bool kFloat = std::is_same_v<Real, float>;
  if (std::isinf(x)) return x > 0 ? "kInf" : "-kInf";
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, "%a%s", static_cast<double>(x), kFloat ? "f" : "");
  return buffer;
}

/// Streams, since g++ 12 sees overlapping memory in chains of operator+ that is not there.
template <class... Parts>
std::string joined(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

template <class Real>
std::string text(const Vec3<Real>& v) {
  return joined('{', text(v.x), ", ", text(v.y), ", ", text(v.z), '}');
}

template <class Real>
std::string text(const Ray<Real>& ray) {
  return joined('{', text(ray.origin), ", ", text(ray.direction), ", ", text(ray.t_min), ", ",
                text(ray.t_max), '}');
}

template <class Real>
std::string text(const hard::Case<Real>& c) {
  return joined('{', text(c.ray), ",\n ", text(c.a), ", ", text(c.b), ", ", text(c.c), ",\n ",
                c.range == Range::Closed ? "Range::Closed}" : "Range::OpenStart}");
}

template <class Real>
std::string text(const Hit<Real>& hit) {
  if (hit.triangle == kNone && std::isinf(hit.t) && hit.u == 0) return "no hit";
  return joined("t ", text(hit.t), " u ", text(hit.u), " v ", text(hit.v), " w ", text(hit.w),
                " of ", hit.geometry, ':', hit.triangle,
                hit.facing == Facing::Front ? " front" : " back");
}

template <class Real>
bool same_bits(Real x, Real y) {
  using Bits = std::conditional_t<std::is_same_v<Real, float>, std::uint32_t, std::uint64_t>;
  return std::bit_cast<Bits>(x) == std::bit_cast<Bits>(y);
}

template <class Real>
bool same_bits(const Hit<Real>& x, const Hit<Real>& y) {
  return same_bits(x.t, y.t) && same_bits(x.u, y.u) && same_bits(x.v, y.v) && same_bits(x.w, y.w) &&
         x.geometry == y.geometry && x.triangle == y.triangle && x.facing == y.facing;
}

}  // namespace pierce::show
