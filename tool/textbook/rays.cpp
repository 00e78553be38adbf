// SPDX-License-Identifier: Apache-2.0
#include "textbook/rays.h"

#include <cmath>
#include <limits>

#include "check/lots.h"
#include "pierce/textbook/cramer.h"
#include "support/parallel.h"

namespace pierce::tool {
namespace {

template <class Real>
Vec3<Real> cube(Lots& lots) {
  return convert<Real>(lots.cube());
}

// Multiples of 1/8: sums and products of a few of them are exact even in float.
template <class Real>
Vec3<Real> lattice(Lots& lots) {
  const int x = lots.between(-16, 16), y = lots.between(-16, 16), z = lots.between(-16, 16);
  return {static_cast<Real>(x) / 8, static_cast<Real>(y) / 8, static_cast<Real>(z) / 8};
}

// Moves one component by 0, 1 or 2 ulp.
template <class Real>
void nudge(Lots& lots, Vec3<Real>& p) {
  const int steps = lots.between(-2, 2);
  const std::uint32_t axis = lots.below(3);
  Real& x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  const Real towards = std::copysign(std::numeric_limits<Real>::infinity(), Real(steps));
  for (int i = std::abs(steps); i > 0; --i) x = std::nextafter(x, towards);
}

template <class Real>
Vec3<Real> on_edge(Lots& lots, const Vec3<Real>& p, const Vec3<Real>& q) {
  return p + static_cast<Real>(lots.between(0, 16)) / 16 * (q - p);
}

// In the triangle one time in four, otherwise beside it.
template <class Real>
Vec3<Real> near_triangle(Lots& lots, const TextbookRay<Real>& pair) {
  const auto u = static_cast<Real>(lots.symmetric()), v = static_cast<Real>(lots.symmetric());
  return pair.a + std::abs(u) * (pair.b - pair.a) + v * (pair.c - pair.a);
}

template <class Real>
void aim(Lots& lots, TextbookRay<Real>& pair, const Vec3<Real>& target) {
  pair.ray.origin = Real(2) * cube<Real>(lots);
  pair.ray.direction = target - pair.ray.origin;
}

template <class Real>
void draw(Lots& lots, std::string_view kind, TextbookRay<Real>& pair) {
  auto& [ray, a, b, c, answer, front] = pair;
  a = cube<Real>(lots);
  b = cube<Real>(lots);
  c = cube<Real>(lots);
  if (kind == "easy") {
    aim(lots, pair, near_triangle(lots, pair));
  } else if (kind == "vertices") {
    aim(lots, pair, a);
    nudge(lots, ray.direction);
  } else if (kind == "edges") {
    aim(lots, pair, on_edge(lots, b, c));
    nudge(lots, ray.direction);
  } else if (kind == "grazing") {  // 2^-4 to 2^-20 out of the plane
    const Vec3<Real> target = near_triangle(lots, pair);
    const auto along_ab = static_cast<Real>(lots.symmetric());
    const auto along_ac = static_cast<Real>(lots.symmetric());
    const Real out = std::ldexp(static_cast<Real>(lots.symmetric()), -lots.between(4, 20));
    ray.direction = along_ab * (b - a) + along_ac * (c - a) + out * cross(b - a, c - a);
    ray.origin = target - ray.direction;
  } else if (kind == "needles") {  // two corners 2^-10 to 2^-20 apart, the ray through the middle
    c = b + std::ldexp(Real(1), -lots.between(10, 20)) * cube<Real>(lots);
    aim(lots, pair, on_edge(lots, a, Real(0.5) * (b + c)));
  } else if (kind == "coplanar") {  // exactly: every step is exact on the lattice
    a = lattice<Real>(lots);
    b = lattice<Real>(lots);
    c = lattice<Real>(lots);
    const auto j = static_cast<Real>(lots.between(-3, 3)),
               k = static_cast<Real>(lots.between(1, 3));
    ray.direction = j * (b - a) + k * (c - a);
    ray.origin = on_edge(lots, a, b) - ray.direction;
  } else {  // small: triangles of millimetres in a room of metres
    const Vec3<Real> centre = a;
    for (Vec3<Real>* corner : {&a, &b, &c}) *corner = centre + Real(0.001) * cube<Real>(lots);
    aim(lots, pair, near_triangle(lots, pair));
  }
}

}  // namespace

template <class Real>
std::vector<TextbookRay<Real>> textbook_rays(std::size_t kind, std::uint64_t count,
                                             std::uint64_t seed) {
  std::vector<TextbookRay<Real>> pairs(count);
  parallel::for_each(std::uint64_t{0}, count, [&](std::uint64_t i) {
    TextbookRay<Real>& pair = pairs[i];
    Lots lots(seed, i * kRayKinds.size() + kind);
    do {
      draw(lots, kRayKinds[kind], pair);
    } while (pair.ray.direction == Vec3<Real>{0, 0, 0});

    const auto ray = convert<Fraction>(pair.ray);
    const auto a = convert<Fraction>(pair.a), b = convert<Fraction>(pair.b),
               c = convert<Fraction>(pair.c);
    const std::optional<TextbookHit<Fraction>> hit = textbook::cramer(ray, a, b, c);
    if (!hit) return;
    pair.answer = {reference(hit->t), reference(hit->u), reference(hit->v)};
    pair.front = dot(cross(b - a, c - a), ray.direction) < 0;
  });
  return pairs;
}

template std::vector<TextbookRay<float>> textbook_rays(std::size_t, std::uint64_t, std::uint64_t);
template std::vector<TextbookRay<double>> textbook_rays(std::size_t, std::uint64_t, std::uint64_t);

}  // namespace pierce::tool
