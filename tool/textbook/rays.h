// SPDX-License-Identifier: Apache-2.0
//
// The rays of `pierce textbook`: pairs of a ray and a triangle, easy ones and five kinds of hard
// ones, each with its exact answer.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "fractions.h"
#include "pierce/textbook/common.h"

namespace pierce::tool {

/// The kinds, in the order in which they are drawn and shown.
inline constexpr std::array<std::string_view, 7> kRayKinds = {
    "easy", "vertices", "edges", "grazing", "needles", "coplanar", "small"};
inline constexpr std::size_t kEasy = 0;

template <class Real>
struct TextbookRay {
  Ray<Real> ray;
  Vec3<Real> a, b, c;
  std::optional<std::array<Reference, 3>> answer;  ///< the exact t, u, v, if it is a hit
  bool front = false;                              ///< N . direction < 0, if it is a hit
};

/// `count` pairs of a kind with their answers, on all cores. Pair i depends on (kind, seed, i)
/// alone.
template <class Real>
[[nodiscard]] std::vector<TextbookRay<Real>> textbook_rays(std::size_t kind, std::uint64_t count,
                                                           std::uint64_t seed);

extern template std::vector<TextbookRay<float>> textbook_rays(std::size_t, std::uint64_t,
                                                              std::uint64_t);
extern template std::vector<TextbookRay<double>> textbook_rays(std::size_t, std::uint64_t,
                                                               std::uint64_t);

}  // namespace pierce::tool
