// SPDX-License-Identifier: Apache-2.0
//
// What `pierce triangle` and `pierce textbook` print: the textbook methods beside the exact answer,
// for one ray and one triangle, and for many.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>

#include "pierce/types.h"

namespace pierce::tool {

/// One ray and one triangle, as the numbers given.
struct TriangleQuestion {
  Vec3<double> a, b, c;
  Ray<double> ray;
};

/// From the numbers of the command line: 9 of the triangle; 6 of the ray (origin, direction), or 8
/// (t_min and t_max as well, which may be infinite). Throws UsageError for another count, Error for
/// numbers that are not finite, a direction of zero or a NaN range.
[[nodiscard]] TriangleQuestion triangle_question(std::span<const double> triangle,
                                                 std::span<const double> ray);

/// The exact answer as fractions and as decimals, how many decisions are wrong, and a table of what
/// every method makes of it in float, double and long double, each answer judged.
void run_triangle(const TriangleQuestion& question, std::ostream& out);

/// The exact answer in a few words: "hit, inside, from the front", "miss: u < 0".
[[nodiscard]] std::string exact_verdict(const TriangleQuestion& question);

/// The ray, the triangle and where they meet as a drawing (SVG), with the exact answer below it.
[[nodiscard]] std::string triangle_picture(const TriangleQuestion& question);

/// Draws `rays` easy and `rays` hard pairs of a ray and a triangle, in float and in double, and
/// prints for every method and type: ns a test, wrong decisions, errors in ulp; as Markdown tables.
/// All but the times depends on (rays, seed) alone. Throws UsageError for fewer than 6 rays.
void run_textbook(std::uint64_t rays, std::uint64_t seed, std::ostream& out);

}  // namespace pierce::tool
