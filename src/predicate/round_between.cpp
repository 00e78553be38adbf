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

#include "exact/fixed_int.h"
#include "exact/round_places.h"
#include "predicate/determinants.h"
#include "predicate/settle.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

using exact::Int128;
using exact::Uint128;

// A coordinate or a difference of two; products and sums of products are taken modulo 2^128.
struct Word {
  std::int64_t value;
};
Word operator-(Word p, Word q) { return {p.value - q.value}; }
Uint128 operator*(Word p, Word q) {
  return static_cast<Uint128>(static_cast<Int128>(p.value) * q.value);
}
Uint128 operator*(Uint128 p, Word q) { return p * static_cast<Uint128>(Int128{q.value}); }

constexpr int kWordBits = 60;

// Numbers as words, each times 2^place. False if they do not fit, or are too large or too small for
// the arithmetic below.
template <std::size_t N>
bool to_words(const double (&numbers)[N], Word (&words)[N], int& place) {
  double most = 0;
  for (const double x : numbers) most = std::max(most, std::fabs(x));
  if (!(most > 0x1p-400 && most < 0x1p400)) return false;
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(most) >> 52) - 1022;
  const auto power = [](int e) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
  };
  const double scale = power(kWordBits - exponent), back = power(exponent - kWordBits);
  std::int64_t all = 0;
  bool exact = true;
  for (std::size_t i = 0; i < N; ++i) {
    words[i].value = static_cast<std::int64_t>(numbers[i] * scale);
    exact &= static_cast<double>(words[i].value) * back == numbers[i];
    all |= words[i].value;
  }
  if (!exact) return false;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(all));
  for (Word& word : words) word.value >>= zeros;
  place = exponent - kWordBits + zeros;
  return true;
}

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

struct Words {
  Triple<Word> s, e1, e2, d;
  int t_place;
};

bool to_words(const RayD& ray, const TriangleD& triangle, Words& out) {
  const auto& [a, b, c] = triangle;
  const auto& o = ray.origin;
  Word p[12], d[3];
  int points = 0, direction = 0;
  if (!to_words({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, o.x, o.y, o.z}, p, points) ||
      !to_words({ray.direction.x, ray.direction.y, ray.direction.z}, d, direction))
    return false;
  const auto at = [&](int i) { return Triple<Word>{p[i], p[i + 1], p[i + 2]}; };
  out = {at(0) - at(9), at(3) - at(0), at(6) - at(0), {d[0], d[1], d[2]}, points - direction};
  return true;
}

Uint128 shifted(Uint128 x, int shift) { return shift < 128 ? x << shift : 0; }

}  // namespace

template <class Real>
std::uint8_t round_between(const RayD& ray, const TriangleD& triangle, std::uint8_t wanted,
                           const Hit<Real>& high, Hit<Real>& low) {
  Words words;
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
  decide(kNumberT, value.t, words.t_place, high.t, low.t);
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
