// SPDX-License-Identifier: Apache-2.0
//
// The number is n / d, the border between its two neighbours m, and the question the sign of
// n - m d, over integers. All of it is computed modulo 2^128: n, d and the product may be as large
// as they like, as long as the difference is less than 2^127, and that is known beforehand, for the
// number is no farther from the border than three times the neighbours are
// (docs/algorithm.md, "Rounding").
#include "predicate/round_between.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "exact/round_places.h"
#include "predicate/determinants.h"
#include "predicate/settle.h"
#include "predicate/words.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

using exact::Int128;
using exact::Uint128;

int bits(const Triple<Word>& p) {
  const auto size = [](Word x) {
    return static_cast<std::uint64_t>(x.value < 0 ? -x.value : x.value);
  };
  return static_cast<int>(std::bit_width(size(p.x) | size(p.y) | size(p.z)));
}

// Two neighbours, and the border between them: `odd` times 2^place, an odd number.
struct Border {
  bool usable, negative;
  std::int64_t odd;
  int place;

  template <class Real>
  Border(Real low, Real high) {
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr int kFraction = std::numeric_limits<Real>::digits - 1;
    negative = high < 0;
    const Bits less = std::bit_cast<Bits>(negative ? -high : low);
    const Bits more = std::bit_cast<Bits>(negative ? -low : high);
    const auto exponent = static_cast<int>(more >> kFraction);  // its sign is +
    usable = less != 0 && less + 1 == more && (low > 0 || negative) &&
             exponent != 2 * std::numeric_limits<Real>::max_exponent - 1;
    const auto field = static_cast<int>(less >> kFraction);
    const Bits significand =
        (less & ((Bits{1} << kFraction) - 1)) | (field == 0 ? 0 : Bits{1} << kFraction);
    odd = 2 * static_cast<std::int64_t>(significand) + 1;
    place = std::max(field, 1) - 1 + exact::lowest_place<Real>() - 1;
  }
  // Whether of the magnitudes the lower one is even.
  [[nodiscard]] bool lower_is_even() const { return (odd & 2) == 0; }
};

Uint128 shifted(Uint128 x, int shift) { return shift < 128 ? x << shift : 0; }

}  // namespace

template <class Real>
std::uint8_t round_between(const RayD& ray, const TriangleD& triangle, std::uint8_t wanted,
                           const Hit<Real>& high, Hit<Real>& low) {
  const auto may_decide = [wanted](std::uint8_t number, Real under, Real over) {
    return (wanted & number) != 0 && Border(under, over).usable;
  };
  Words words;
  if (!may_decide(kNumberT, low.t, high.t) && !may_decide(kNumberU, low.u, high.u) &&
      !may_decide(kNumberV, low.v, high.v) && !may_decide(kNumberW, low.w, high.w))
    return 0;
  if (!to_words(ray, triangle, words)) return 0;
  // den is less than 6 times their product, the difference at most 3 times den.
  const int den_bits = bits(words.e1) + bits(words.e2) + bits(words.d) + 5;
  const bool den_negative = low.facing == Facing::Front;
  const auto value = determinants_of(words.s, words.e1, words.e2, words.d);
  const Uint128 den = den_negative ? -value.den : value.den;
  std::uint8_t done = 0;
  const auto decide = [&](std::uint8_t number, Uint128 numerator, int place, Real over,
                          Real& under) {
    if ((wanted & number) == 0) return;
    const Border border(under, over);
    const int shift = place - border.place;
    if (!border.usable || den_bits + std::max(0, -shift) > 127) return;
    const Uint128 n = den_negative != border.negative ? -numerator : numerator;
    const Uint128 middle = den * static_cast<Uint128>(border.odd);
    const auto above =
        static_cast<Int128>(shifted(n, std::max(0, shift)) - shifted(middle, std::max(0, -shift)));
    const bool larger = above > 0 || (above == 0 && !border.lower_is_even());
    if (larger != border.negative) under = over;
    done |= number;
  };
  decide(kNumberT, value.t, words.t_place(), high.t, low.t);
  decide(kNumberU, value.u, 0, high.u, low.u);
  decide(kNumberV, value.v, 0, high.v, low.v);
  decide(kNumberW, value.w, 0, high.w, low.w);
  return done;
}

template std::uint8_t round_between<float>(const RayD&, const TriangleD&, std::uint8_t,
                                           const Hit<float>&, Hit<float>&);
template std::uint8_t round_between<double>(const RayD&, const TriangleD&, std::uint8_t,
                                            const Hit<double>&, Hit<double>&);

}  // namespace pierce::predicate
