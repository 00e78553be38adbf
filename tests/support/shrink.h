// SPDX-License-Identifier: Apache-2.0
//
// Makes a failing case small while it goes on failing: fewer triangles, plainer numbers. `fails`
// must be a pure function of what is shrunk.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pierce/types.h"
#include "support/hard_cases.h"
#include "support/meshes.h"

namespace pierce::hard {

/// How hard a number is to read: 0 for zero, else its significant bits and the size of its
/// exponent.
template <class Real>
int plainness(Real x) {
  if (x == 0) return std::signbit(x) ? 1 : 0;
  if (std::isinf(x)) return 2;
  int exponent = 0;
  Real fraction = std::frexp(x, &exponent);
  int bits = 0;
  for (fraction = std::fabs(fraction); fraction != 0; ++bits) {
    fraction = 2 * fraction - std::floor(2 * fraction);
  }
  return 4 + 2 * bits + std::abs(exponent) / 4 + (x < 0 ? 1 : 0);
}

/// Replaces each number by plainer ones as long as `fails()` stays true.
template <class Real, class Fails>
bool shrink_numbers(const std::vector<Real*>& numbers, Fails fails) {
  bool shrunk = false;
  for (Real* x : numbers) {
    const Real inf = std::numeric_limits<Real>::infinity();
    std::vector<Real> plainer = {0, 1, -1, inf, -inf, -*x};
    if (std::isfinite(*x)) {
      int exponent = 0;
      const Real fraction = std::frexp(*x, &exponent);
      plainer.push_back(fraction);
      plainer.push_back(2 * fraction);
      for (int bits = 1; bits < std::numeric_limits<Real>::digits; ++bits) {
        const Real cut = std::trunc(std::ldexp(fraction, bits));
        plainer.push_back(std::ldexp(cut, exponent - bits));
      }
    }
    for (const Real candidate : plainer) {
      if (plainness(candidate) >= plainness(*x)) continue;
      const Real before = *x;
      *x = candidate;
      if (fails()) {
        shrunk = true;
        break;
      }
      *x = before;
    }
  }
  return shrunk;
}

template <class Real>
void append_numbers(Vec3<Real>& v, std::vector<Real*>& numbers) {
  numbers.insert(numbers.end(), {&v.x, &v.y, &v.z});
}

template <class Real>
std::vector<Real*> numbers_of(Ray<Real>& ray) {
  std::vector<Real*> numbers = {&ray.t_min, &ray.t_max};
  append_numbers(ray.origin, numbers);
  append_numbers(ray.direction, numbers);
  return numbers;
}

template <class Real>
std::vector<Real*> numbers_of(Case<Real>& hard) {
  std::vector<Real*> numbers = numbers_of(hard.ray);
  for (Vec3<Real>* v : {&hard.a, &hard.b, &hard.c}) append_numbers(*v, numbers);
  return numbers;
}

/// What no number can do by itself: moves all points until one of them is 0, and brings points and
/// direction to the size of 1.
template <class Real, class Fails>
bool shrink_together(Case<Real>& hard, Fails fails) {
  const auto total = [](Case<Real> c) {
    int sum = 0;
    for (const Real* x : numbers_of(c)) sum += plainness(*x);
    return sum;
  };
  const auto points_of = [](Case<Real>& c) { return std::array{&c.a, &c.b, &c.c, &c.ray.origin}; };
  bool shrunk = false;
  const auto keep_if_plainer = [&](const Case<Real>& next) {
    if (total(next) >= total(hard) || !fails(next)) return;
    hard = next;
    shrunk = true;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    Case<Real> next = hard;
    const Vec3<Real> to = *points_of(next)[i];
    for (Vec3<Real>* p : points_of(next)) *p = {p->x - to.x, p->y - to.y, p->z - to.z};
    keep_if_plainer(next);
  }
  const auto scale_to_one = [](const auto& vectors) {
    Real size = 0;
    for (const Vec3<Real>* p : vectors) {
      size = std::max({size, std::fabs(p->x), std::fabs(p->y), std::fabs(p->z)});
    }
    if (size == 0) return;
    const int by = -std::ilogb(size);
    for (Vec3<Real>* p : vectors) {
      *p = {std::ldexp(p->x, by), std::ldexp(p->y, by), std::ldexp(p->z, by)};
    }
  };
  Case<Real> next = hard;
  scale_to_one(points_of(next));
  keep_if_plainer(next);
  next = hard;
  scale_to_one(std::array{&next.ray.direction});
  keep_if_plainer(next);
  return shrunk;
}

template <class Real, class Fails>
Case<Real> shrunk(Case<Real> hard, Fails fails) {
  const auto still = [&](const Case<Real>& c) {
    return is_valid(c.ray) && is_finite(c.a) && is_finite(c.b) && is_finite(c.c) && fails(c);
  };
  for (bool again = true; again;) {
    again = shrink_together(hard, still);
    again = shrink_numbers(numbers_of(hard), [&] { return still(hard); }) || again;
  }
  return hard;
}

/// A mesh and a ray: first triangles are dropped in ever smaller chunks, then numbers are made
/// plainer. `fails(mesh, ray)`.
template <class Real, class Fails>
void shrink(Mesh<Real>& mesh, Ray<Real>& ray, Fails fails) {
  auto& triangles = mesh.triangles;
  for (std::size_t chunk = triangles.size(); chunk > 0; chunk /= 2) {
    for (std::size_t at = 0; at < triangles.size();) {
      const auto before = triangles;
      const auto first = triangles.begin() + static_cast<std::ptrdiff_t>(at);
      const auto count = std::min(chunk, triangles.size() - at);
      triangles.erase(first, first + static_cast<std::ptrdiff_t>(count));
      if (!fails(mesh, ray)) {
        triangles = before;
        at += chunk;
      }
    }
  }
  if (triangles.size() > 64) return;  // numbers of a large mesh would take for ever
  std::vector<Real*> numbers = numbers_of(ray);
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (!used[vertex]) append_numbers(mesh.vertices[vertex], numbers);
      used[vertex] = true;
    }
  }
  const auto still = [&] {
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] && !is_finite(mesh.vertices[i])) return false;
    }
    return is_valid(ray) && fails(mesh, ray);
  };
  while (shrink_numbers(numbers, still)) {
  }
}

}  // namespace pierce::hard
