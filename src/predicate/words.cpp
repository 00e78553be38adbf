// SPDX-License-Identifier: Apache-2.0
#include "predicate/words.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "exact/binary_parts.h"

namespace pierce::predicate {
namespace {

constexpr int kWordBits = 60;

// Numbers as words, each times 2^place.
template <std::size_t N>
bool to_words(const double (&numbers)[N], Word (&words)[N], int& place) {
  double most = 0;
  for (const double x : numbers) most = std::max(most, std::fabs(x));
  if (!(most > 0x1p-400 && most < 0x1p400)) return false;
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(most) >> 52) - 1022;
  const double scale = exact::power_of_two(kWordBits - exponent);
  const double back = exact::power_of_two(exponent - kWordBits);
  std::int64_t all = 0;
  bool all_fit = true;
  for (std::size_t i = 0; i < N; ++i) {
    words[i].value = static_cast<std::int64_t>(numbers[i] * scale);
    all_fit &= static_cast<double>(words[i].value) * back == numbers[i];
    all |= words[i].value;
  }
  if (!all_fit) return false;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(all));
  for (Word& word : words) word.value >>= zeros;
  place = exponent - kWordBits + zeros;
  return true;
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

}  // namespace pierce::predicate
