// SPDX-License-Identifier: Apache-2.0
#include "predicate/words.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace pierce::predicate {
namespace {

using exact::Int128;
using exact::Uint128;

constexpr int kWordBits = 60;

// Numbers as words, each times 2^place.
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

int sign_of_word(Uint128 x) {
  const auto number = static_cast<Int128>(x);
  return (number > 0 ? 1 : 0) - (number < 0 ? 1 : 0);
}

}  // namespace

bool to_words(const RayD& ray, const TriangleD& triangle, Words& out) {
  const auto& [a, b, c] = triangle;
  const auto& o = ray.origin;
  Word p[12], d[3];
  int points = 0, direction = 0;
  if (!to_words({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, o.x, o.y, o.z}, p, points) ||
      !to_words({ray.direction.x, ray.direction.y, ray.direction.z}, d, direction))
    return false;
  const auto at = [&](int i) { return Triple<Word>{p[i], p[i + 1], p[i + 2]}; };
  out = {at(0) - at(9), at(3) - at(0), at(6) - at(0), {d[0], d[1], d[2]}, points, direction};
  return true;
}

SmallSigns::SmallSigns(const RayD& ray, const TriangleD& triangle, const Filtered& f) {
  Words words;
  if (!to_words(ray, triangle, words)) return;
  const auto value = determinants_of(words.s, words.e1, words.e2, words.d);
  const auto sign = [](Uint128 x, double rough, double err, int place) -> std::optional<int> {
    int exponent = 0;
    std::frexp(std::fabs(rough) + err, &exponent);  // what it is less than, as a power of two
    if (exponent - place > 125) return {};
    return sign_of_word(x);
  };
  const int mixed = words.mixed_place();
  den = sign(value.den, f.value.den, f.den_err, mixed);
  u = sign(value.u, f.value.u, f.uv_err, mixed);
  v = sign(value.v, f.value.v, f.uv_err, mixed);
  w = sign(value.w, f.value.w, f.w_err, mixed);
  t = sign(value.t, f.value.t, f.t_err, words.lengths_place());
}

}  // namespace pierce::predicate
