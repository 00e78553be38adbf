// SPDX-License-Identifier: Apache-2.0
//
// The one-ray-one-triangle cases that the micro-benchmarks share: ordinary ones, about half of
// which hit, hard ones, aimed exactly at edges, which no filter can decide, and wild ones, whose
// numbers are of all sizes.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "predicate/types.h"
#include "workloads/prng.h"
#include "workloads/vector.h"

namespace pierce::bench {

struct Case {
  predicate::RayD ray;
  predicate::TriangleD triangle;
};

inline constexpr std::size_t kCases = 1024;  // fit the cache

/// Coordinates are floats or doubles; either way held in doubles.
template <class Real>
Double3 random_point(Prng& random) {
  return to_double(
      convert<Real>(Double3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}));
}

/// Aimed at a random point of the triangle's parallelogram: one in two hits.
template <class Real>
std::vector<Case> ordinary_cases() {
  Prng random(1);
  std::vector<Case> cases;
  while (cases.size() < kCases) {
    Case c;
    c.triangle = {random_point<Real>(random), random_point<Real>(random),
                  random_point<Real>(random)};
    c.ray.origin = 3.0 * random_point<float>(random);
    const double u = random.unit();
    const double v = random.unit();
    const Double3& a = c.triangle.a;
    const Double3 target = a + u * (c.triangle.b - a) + v * (c.triangle.c - a);
    c.ray.direction = to_double(convert<Real>(target - c.ray.origin));
    cases.push_back(c);
  }
  return cases;
}

/// Aimed exactly at the middle of the edge (b, c): u + v = 1 exactly, which rounding cannot tell
/// from a miss. Built so that every number is a Real: b and c lie evenly about the target.
template <class Real>
std::vector<Case> hard_cases() {
  constexpr double kGrid = sizeof(Real) == 4 ? 0x1p21 : 0x1p50;  // sums and differences stay exact
  const auto snapped = [](double x) { return std::nearbyint(x * kGrid) / kGrid; };
  Prng random(2);
  const auto point = [&] {
    return Double3{snapped(random.between(-1, 1)), snapped(random.between(-1, 1)),
                   snapped(random.between(-1, 1))};
  };
  std::vector<Case> cases;
  while (cases.size() < kCases) {
    Case c;
    const Double3 middle = point();
    const Double3 half = point();
    c.triangle = {point(), middle + half, middle - half};
    c.ray.direction = point();
    c.ray.origin = middle - c.ray.direction;
    cases.push_back(c);
  }
  return cases;
}

/// Every coordinate of a size of its own, between 2^-500 and 2^500: only integers of any size hold
/// such cases. The ray meets the triangle's plane somewhere.
inline std::vector<Case> wild_cases() {
  Prng random(3);
  const auto number = [&] {
    return std::ldexp(random.between(-1, 1), static_cast<int>(random.between(-500, 500)));
  };
  const auto point = [&] { return Double3{number(), number(), number()}; };
  std::vector<Case> cases(kCases);
  for (Case& c : cases) c = {{point(), point()}, {point(), point(), point()}};
  return cases;
}

}  // namespace pierce::bench
