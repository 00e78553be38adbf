// SPDX-License-Identifier: Apache-2.0
//
// Double arithmetic that knows whether it rounded. Where coordinates have few bits, as on grids,
// whatever does not matter vanishes in differences and products, and the determinants that tell an
// edge from its two sides come out exactly: a ray through a vertex then needs no integers.
#pragma once

#include <cstdint>

#include "predicate/determinants.h"
#include "predicate/filtered.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// Two numbers side by side, and what was rounded off on the way to each: 0 (of either sign) if
/// nothing was.
struct Unrounded {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  Twin value;
  Bits lost;
};

inline Unrounded::Bits bits_of(Twin p) { return reinterpret_cast<Unrounded::Bits>(p); }

/// Knuth's sum: what is lost is exactly what the sum lacks.
inline Unrounded operator+(const Unrounded& p, const Unrounded& q) {
  const Twin sum = p.value + q.value;
  const Twin q_part = sum - p.value, p_part = sum - q_part;
  return {sum, p.lost | q.lost | bits_of((p.value - p_part) + (q.value - q_part))};
}
inline Unrounded operator-(const Unrounded& p) { return {-p.value, p.lost}; }
inline Unrounded operator-(const Unrounded& p, const Unrounded& q) { return p + -q; }

/// Exact if both factors have 26 bits at most, or one is 0; nothing may under- or overflow.
inline Unrounded operator*(const Unrounded& p, const Unrounded& q) {
  constexpr std::int64_t kLast = (std::int64_t{1} << 27) - 1;  // of 53
  const auto doubt = [](const Unrounded& x) { return x.lost | (bits_of(x.value) & kLast); };
  return {p.value * q.value, (doubt(p) & (q.value != 0)) | (doubt(q) & (p.value != 0))};
}

/// Triples that nothing has been lost of.
inline Triple<Unrounded> unrounded(const Triple<Twin>& p) {
  constexpr Unrounded::Bits kNothing{};
  return {Unrounded{p.x, kNothing}, Unrounded{p.y, kNothing}, Unrounded{p.z, kNothing}};
}

/// No component is as small as kSmallestExact, unless it is zero. Products of three others are
/// whole multiples of 2^-906, so that what a product rounds off is a double.
inline bool none_is_tiny(const Triple<Unrounded>& p) {
  using Words = std::uint64_t __attribute__((vector_size(16)));
  constexpr std::uint64_t kSmallestExact = std::uint64_t{1023 - 250} << 53;  // 2^-250, twice
  const auto large = [](Twin x) {  // zero less one is more than anything
    return ((reinterpret_cast<Words>(x) << 1) - 1 >= kSmallestExact - 1);
  };
  const auto all = large(p.x.value) & large(p.y.value) & large(p.z.value);
  return (all[0] & all[1]) != 0;
}

/// Of a pair whose magnitudes are those of the double rung (Filtered::usable): the signs of den, U,
/// V and W, -1, 0 or 1, as far as double arithmetic came to them without rounding.
struct UnroundedSigns {
  bool known_u = false, known_v = false, known_w = false;
  int u = 0, v = 0, w = 0;

  UnroundedSigns(const RayD& ray, const TriangleD& triangle) {
    const auto e1_d =
        unrounded(beside(triangle.b, ray.direction)) - unrounded(beside(triangle.a, {0, 0, 0}));
    const auto e2_s =
        unrounded(beside(triangle.c, triangle.a)) - unrounded(beside(triangle.a, ray.origin));
    if (!none_is_tiny(e1_d) || !none_is_tiny(e2_s)) return;
    // (E1, d) x (E2, S) is (N, R).
    const auto n_r = cross(e1_d, e2_s);
    const auto turned_round = [](const Unrounded& p) {
      return Unrounded{turned(p.value), Unrounded::Bits{p.lost[1], p.lost[0]}};
    };
    const Triple<Unrounded> d_e1{turned_round(e1_d.x), turned_round(e1_d.y), turned_round(e1_d.z)};
    const Triple<Unrounded> s_e2{turned_round(e2_s.x), turned_round(e2_s.y), turned_round(e2_s.z)};
    const Unrounded den_v = dot(n_r, d_e1), t_u = dot(n_r, s_e2);
    // R . E2 is -U: den - U - V, in the first.
    const Unrounded den_less = den_v + turned_round(t_u) - turned_round(den_v);
    known_u = is_none(t_u.lost[1]);
    known_v = is_none(den_v.lost[1]);
    known_w = is_none(den_less.lost[0]);
    u = -sign(t_u.value[1]);
    v = sign(den_v.value[1]);
    w = sign(den_less.value[0]);
  }

 private:
  static bool is_none(std::int64_t lost) { return static_cast<std::uint64_t>(lost) << 1 == 0; }
  static int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
};

}  // namespace pierce::predicate
