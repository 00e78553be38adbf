// SPDX-License-Identifier: Apache-2.0
//
// Exact and quick: one ray and one triangle whose numbers are multiples of 2^-55 within 4 (points
// within 2, directions below 2). Products of two such numbers fit 128 bits and those of three 192,
// so that 10^8 decisions take minutes. Shares nothing with the library.
#pragma once

#include <gmpxx.h>

#include <cmath>
#include <cstdint>

#include "predicate/types.h"

namespace pierce::siege {

using Int = std::int64_t;
using Int2 = __int128;

inline constexpr double kGrid = 0x1p-55;

inline Int to_grid(double x) { return static_cast<Int>(x / kGrid); }
inline bool on_the_grid(double x) {
  return std::fabs(x) <= 4 && static_cast<double>(to_grid(x)) * kGrid == x;
}
inline bool on_the_grid(const Vec3<double>& p) {
  return on_the_grid(p.x) && on_the_grid(p.y) && on_the_grid(p.z);
}

template <class N>
struct Triple {
  N x, y, z;
};
inline Triple<Int> to_grid(const Vec3<double>& p) {
  return {to_grid(p.x), to_grid(p.y), to_grid(p.z)};
}
inline Triple<Int> operator-(const Triple<Int>& p, const Triple<Int>& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}
inline Triple<Int2> cross(const Triple<Int>& p, const Triple<Int>& q) {
  const auto minor = [](Int a, Int b, Int c, Int d) { return Int2{a} * d - Int2{b} * c; };
  return {minor(p.y, p.z, q.y, q.z), minor(p.z, p.x, q.z, q.x), minor(p.x, p.y, q.x, q.y)};
}

/// high * 2^64 + low.
struct Wide {
  Int2 high = 0;
  std::uint64_t low = 0;

  [[nodiscard]] int sign() const { return high < 0 ? -1 : high != 0 || low != 0 ? 1 : 0; }
  friend Wide operator-(const Wide& a, const Wide& b) {
    return {a.high - b.high - (a.low < b.low ? 1 : 0), a.low - b.low};
  }
  /// Within three roundings.
  [[nodiscard]] double approximate() const {
    if (high < 0) return -(Wide{} - *this).approximate();
    return static_cast<double>(high) * 0x1p64 + static_cast<double>(low);
  }
  [[nodiscard]] mpz_class exact() const {
    const mpz_class top = static_cast<long>(high >> 64);
    const mpz_class bottom = static_cast<std::uint64_t>(high);
    return (((top << 64) + bottom) << 64) + mpz_class(low);
  }
};

inline Wide dot(const Triple<Int2>& p, const Triple<Int>& q) {
  Int2 high = 0, low = 0;
  const auto add = [&](Int2 a, Int b) {
    high += (a >> 64) * b;
    low += Int2{static_cast<std::uint64_t>(a)} * b;
  };
  add(p.x, q.x);
  add(p.y, q.y);
  add(p.z, q.z);
  return {high + (low >> 64), static_cast<std::uint64_t>(low)};
}

/// The line of a ray and a triangle, both on the grid.
class GridPair {
 public:
  GridPair(const Triple<Int>& origin, const Triple<Int>& direction,
           const predicate::TriangleD& triangle) {
    const Triple<Int> a = to_grid(triangle.a);
    const Triple<Int> s = a - origin, e1 = to_grid(triangle.b) - a, e2 = to_grid(triangle.c) - a;
    const Triple<Int2> n = cross(e1, e2), r = cross(direction, s);
    den_ = dot(n, direction);
    const Wide v = dot(r, e1), u = Wide{} - dot(r, e2), w = den_ - u - v;
    const int sign = den_.sign();
    hit_ = sign != 0 && u.sign() * sign >= 0 && v.sign() * sign >= 0 && w.sign() * sign >= 0;
    if (hit_) t_ = dot(n, s);
  }

  /// Whether the line meets the closed triangle.
  [[nodiscard]] bool line_hits() const { return hit_; }

  /// The sign of tau - bound, for a line that hits.
  [[nodiscard]] int compare_tau(double bound) const {
    if (std::isinf(bound)) return bound > 0 ? -1 : 1;
    const double tau = t_.approximate() / den_.approximate();
    const double gap = tau - bound;
    if (std::fabs(gap) > 0x1p-48 * (std::fabs(tau) + std::fabs(bound))) return gap < 0 ? -1 : 1;
    // bound = m 2^exponent
    int exponent = 0;
    const auto m = static_cast<long>(std::ldexp(std::frexp(bound, &exponent), 53));
    exponent -= 53;
    mpz_class t = t_.exact(), limit = den_.exact() * m;
    if (exponent < 0)
      t <<= static_cast<mp_bitcnt_t>(-exponent);
    else
      limit <<= static_cast<mp_bitcnt_t>(exponent);
    return cmp(t, limit) * den_.sign();
  }

  /// The sign of this tau less the other's; both lines hit.
  [[nodiscard]] int order(const GridPair& other) const {
    const double tau = t_.approximate() / den_.approximate();
    const double other_tau = other.t_.approximate() / other.den_.approximate();
    const double gap = tau - other_tau;
    if (std::fabs(gap) > 0x1p-48 * (std::fabs(tau) + std::fabs(other_tau))) return gap < 0 ? -1 : 1;
    const mpz_class mine = t_.exact() * other.den_.exact(), its = other.t_.exact() * den_.exact();
    return cmp(mine, its) * den_.sign() * other.den_.sign();
  }

  [[nodiscard]] const Wide& t() const { return t_; }
  [[nodiscard]] const Wide& den() const { return den_; }

 private:
  Wide den_, t_;
  bool hit_ = false;
};

}  // namespace pierce::siege
