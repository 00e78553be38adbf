// SPDX-License-Identifier: Apache-2.0
//
// Determinants modulo 2^128, of coordinates that fit into one word each: exact where they are known
// to be small.
#pragma once

#include <cstdint>

#include "exact/fixed_int.h"
#include "predicate/determinants.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// A coordinate or a difference of two; products and sums of products are taken modulo 2^128.
struct Word {
  std::int64_t value;
};
inline Word operator-(Word p, Word q) { return {p.value - q.value}; }
inline exact::Uint128 operator*(Word p, Word q) {
  return static_cast<exact::Uint128>(static_cast<exact::Int128>(p.value) * q.value);
}
inline exact::Uint128 operator*(exact::Uint128 p, Word q) {
  return p * static_cast<exact::Uint128>(exact::Int128{q.value});
}

/// The numbers of a pair, those of points times 2^point_place, the direction's 2^direction_place.
struct Words {
  Triple<Word> s, e1, e2, d;
  int point_place, direction_place;

  /// The power of two that t counts in.
  [[nodiscard]] int t_place() const { return point_place - direction_place; }
};

/// False if they do not fit, or are too large or too small for what is done with them.
bool to_words(const RayD& ray, const TriangleD& triangle, Words& out);

}  // namespace pierce::predicate
