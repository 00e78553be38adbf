// SPDX-License-Identifier: Apache-2.0
#include "predicate/settle.h"

#include <cmath>

#include "exact/round_fixed.h"
#include "exact/round_ratio.h"
#include "predicate/exact_pair.h"

namespace pierce::predicate {
namespace {

template <class Pair>
bool in_range(const Pair& pair, const RayD& ray) {
  const int start = compare_t(pair, ray.t_min);
  return (start > 0 || (start == 0 && !ray.open_start)) && compare_t(pair, ray.t_max) <= 0;
}

}  // namespace

Settled settle_hit(const RayD& ray, const TriangleD& triangle) {
  Settled result{};
  const auto decide = [&](const auto& pair) {
    if (pair.den_sign == 0) return;
    const int u = sign_of(pair.value.u);
    const int v = sign_of(pair.value.v);
    const int w = sign_of(pair.value.w);
    if (u < 0 || v < 0 || w < 0 || !in_range(pair, ray)) return;
    result.hit = true;
    result.facing = pair.den_sign < 0 ? Facing::Front : Facing::Back;
    result.zeros = static_cast<std::uint8_t>((u == 0 ? kZeroU : 0) | (v == 0 ? kZeroV : 0) |
                                             (w == 0 ? kZeroW : 0));
  };
  result.width = with_exact_pairs(ray, decide, triangle);
  return result;
}

bool settle_has_area(const TriangleD& triangle) {
  // The normal's components are the den of rays along the axes.
  bool area = false;
  for (const Vec3<double>& axis : {Vec3<double>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    with_exact_pairs(
        RayD{triangle.a, axis}, [&](const auto& pair) { area |= pair.den_sign != 0; }, triangle);
  }
  return area;
}

std::strong_ordering settle_order(const RayD& ray, const TriangleD& first,
                                  const TriangleD& second) {
  int sign = 0;
  const auto compare = [&sign](const auto& p, const auto& q) {
    // Both dens are positive, both places the same.
    sign = compare_scaled(p.value.t * q.value.den, 0, q.value.t * p.value.den);
  };
  with_exact_pairs(ray, compare, first, second);
  return sign <=> 0;
}

template <class Real>
void settle_numbers(const RayD& ray, const TriangleD& triangle, std::uint8_t wanted,
                    Hit<Real>& hit) {
  const auto round = [&hit, wanted](const auto& pair) {
    const auto& value = pair.value;
    const auto set = [&](std::uint8_t number, const auto& numerator, int place, Real& to) {
      if ((wanted & number) != 0) to = exact::round_ratio<Real>(numerator, value.den, place);
    };
    set(kNumberT, value.t, pair.t_place, hit.t);
    set(kNumberU, value.u, 0, hit.u);
    set(kNumberV, value.v, 0, hit.v);
    set(kNumberW, value.w, 0, hit.w);
    hit.facing = pair.den_sign < 0 ? Facing::Front : Facing::Back;
  };
  with_exact_pairs(ray, round, triangle);
}

template void settle_numbers<float>(const RayD&, const TriangleD&, std::uint8_t, Hit<float>&);
template void settle_numbers<double>(const RayD&, const TriangleD&, std::uint8_t, Hit<double>&);

}  // namespace pierce::predicate
