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
  using Patterns = std::uint64_t __attribute__((vector_size(16)));
  constexpr std::uint64_t kSmallestExact = std::uint64_t{1023 - 250} << 53;  // 2^-250, twice
  const auto large = [](Twin x) {  // zero less one is more than anything
    return ((reinterpret_cast<Patterns>(x) << 1) - 1 >= kSmallestExact - 1);
  };
  const auto all = large(p.x.value) & large(p.y.value) & large(p.z.value);
  return (all[0] & all[1]) != 0;
}

/// Of a pair whose magnitudes are those of the double rung (Filtered::usable): the signs of U, V
/// and W, -1, 0 or 1, as far as double arithmetic came to them without rounding.
struct UnroundedSigns {
  bool known_u = false, known_v = false, known_w = false;
  int u = 0, v = 0, w = 0;

  // Over the corners, seen from the origin: where the ray passes through one of them, the cross
  // product of both is 0 in all its components, and what it is multiplied with does not matter.
  UnroundedSigns(const RayD& ray, const TriangleD& triangle) {
    const auto from_origin = [&](const Vec3<double>& p, const Vec3<double>& q) {
      return unrounded(beside(p, q)) - unrounded(beside(ray.origin, ray.origin));
    };
    const auto d = unrounded(beside(ray.direction, ray.direction));
    const auto a_b = from_origin(triangle.a, triangle.b), c_c = from_origin(triangle.c, triangle.c);
    if (!none_is_tiny(d) || !none_is_tiny(a_b) || !none_is_tiny(c_c)) return;
    const auto d_a_b = cross(d, a_b), d_c_c = cross(d, c_c);
    const Unrounded v_w = dot(d_a_b, pick<1, 0>(a_b, c_c));  // (d x A) . B, (d x B) . C
    const Unrounded u_less_w = dot(d_c_c, a_b);              // (d x C) . A, (d x C) . B
    const Unrounded less_u_v = dot(d_a_b, pick<0, 0>(c_c, a_b));
    know(u_less_w, 0, 1, known_u, u);
    know(less_u_v, 0, -1, known_u, u);
    know(v_w, 0, 1, known_v, v);
    know(less_u_v, 1, -1, known_v, v);
    know(v_w, 1, 1, known_w, w);
    know(u_less_w, 1, -1, known_w, w);
  }

 private:
  // Of each component one of the two numbers of the first, and one of those of the second.
  template <int kFirst, int kSecond>
  static Triple<Unrounded> pick(const Triple<Unrounded>& p, const Triple<Unrounded>& q) {
    const auto two = [](const Unrounded& x, const Unrounded& y) {
      return Unrounded{Twin{x.value[kFirst], y.value[kSecond]},
                       Unrounded::Bits{x.lost[kFirst], y.lost[kSecond]}};
    };
    return {two(p.x, q.x), two(p.y, q.y), two(p.z, q.z)};
  }
  // The sign of one of two numbers, turned round if `times` is -1.
  static void know(const Unrounded& x, int which, int times, bool& known, int& to) {
    if (known || !is_none(x.lost[which])) return;
    known = true;
    to = times * sign_of_double(x.value[which]);
  }
  static bool is_none(std::int64_t lost) { return static_cast<std::uint64_t>(lost) << 1 == 0; }
};

}  // namespace pierce::predicate
