// SPDX-License-Identifier: Apache-2.0
#include "predicate/settle.h"

#include <cmath>
#include <optional>
#include <type_traits>

#include "exact/round_fixed.h"
#include "exact/round_ratio.h"
#include "predicate/axis_signs.h"
#include "predicate/certify.h"
#include "predicate/corner.h"
#include "predicate/exact_pair.h"
#include "predicate/fine.h"
#include "predicate/unrounded.h"
#include "predicate/words.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

template <class Pair>
bool in_range(const Pair& pair, const RayD& ray) {
  const int start = compare_t(pair, ray.t_min);
  return (start > 0 || (start == 0 && !ray.open_start)) && compare_t(pair, ray.t_max) <= 0;
}

// By the signs of its determinants.
void set_hit(int den, int u, int v, int w, Settled& result) {
  result.hit = true;
  result.facing = den < 0 ? Facing::Front : Facing::Back;
  result.zeros = static_cast<std::uint8_t>((u == 0 ? kZeroU : 0) | (v == 0 ? kZeroV : 0) |
                                           (w == 0 ? kZeroW : 0));
}

template <class Pair>
void settle_all(const RayD& ray, const Pair& pair, Settled& result) {
  if (pair.den_sign == 0) return;
  const int u = sign_of(pair.value.u);
  const int v = sign_of(pair.value.v);
  const int w = sign_of(pair.value.w);
  if (u < 0 || v < 0 || w < 0 || !in_range(pair, ray)) return;
  set_hit(pair.den_sign, u, v, w, result);
}

// What double may be sure of; nothing where it is not.
struct SureSigns {
  std::optional<int> den, u, v, w;  // the signs of the determinants
  std::optional<bool> in_range;     // if there is a hit
  Interval t;                       // of a hit, if that is known better than double knows it
  bool usable;                      // the sizes of all numbers are ordinary
  bool by_words = false;            // integers were asked

  SureSigns(const RayD& ray, const TriangleD& triangle, const Filtered& f) : usable(f.usable) {
    if (f.normal_usable) den = sure(f.value.den, f.den_err);
    if (f.usable) {
      u = sure(f.value.u, f.uv_err);
      v = sure(f.value.v, f.uv_err);
      w = sure(f.value.w, f.w_err);
    }
    if (f.usable && den) {
      if (certify_above(f, ray.t_min) == Certified::Yes &&
          certify_above(f, ray.t_max) == Certified::No)
        in_range = true;
    }
    if (in_range) return;
    const auto place = place_across_axis(ray, triangle);
    if (!place) return;
    in_range = place->in_range(ray);
    t = place->interval();
  }

  // Looks for what it was not sure of in ways that do not round.
  void complete(const RayD& ray, const TriangleD& triangle, const Filtered& f) {
    if (!usable || (den && u && v && w && in_range)) return;
    by_words = true;
    const SmallSigns small(ray, triangle, f);
    if (!den) den = small.den;
    if (!u) u = small.u;
    if (!v) v = small.v;
    if (!w) w = small.w;
    if (!in_range && den && small.t && ray.t_min == 0) {
      const int after_start = *den * *small.t;
      if (after_start < 0 || (after_start == 0 && ray.open_start)) {
        in_range = false;
      } else if (ends_after(ray, f)) {
        in_range = true;
      }
    }
    if (u && v && w) return;
    const UnroundedSigns signs(ray, triangle);
    if (!u && signs.known_u) u = signs.u;
    if (!v && signs.known_v) v = signs.v;
    if (!w && signs.known_w) w = signs.w;
  }

 private:
  // Whether t is surely before the end of the range.
  [[nodiscard]] static bool ends_after(const RayD& ray, const Filtered& f) {
    if (is_infinite(ray.t_max)) return ray.t_max > 0;
    return std::fabs(f.value.den) > f.den_err && certify_above(f, ray.t_max) == Certified::No;
  }
  static std::optional<int> sure(double value, double err) {
    if (value > err) return 1;
    if (value < -err) return -1;
    return {};
  }
};

// Where den is sure, and the hit within the range, if it is one.
template <class Integer>
void settle_weights(const ExactParts<Integer>& parts, const SureSigns& sure, Settled& result) {
  const int den = *sure.den;
  const auto sign = [&](const auto& determinant) { return den * sign_of(determinant); };
  int u = den * sure.u.value_or(0), v = den * sure.v.value_or(0), w = den * sure.w.value_or(0);
  if (!sure.u || !sure.v) {
    const auto r = cross(parts.d, parts.s);
    if (!sure.v) v = sign(dot(r, parts.e1));
    if (v >= 0 && !sure.u) u = -sign(dot(r, parts.e2));
  }
  if (u < 0 || v < 0) return;
  // That of a is what that of c is once the corners have changed places: (b, c, a).
  if (!sure.w) w = sign(dot(cross(parts.d, parts.s + parts.e1), parts.e2 - parts.e1));
  if (w >= 0) set_hit(den, u, v, w, result);
}

}  // namespace

Settled settle_hit(const RayD& ray, const TriangleD& triangle) {
  Settled result{};
  const auto settle = [&](const auto& pair) { settle_all(ray, pair, result); };
  const Width width = with_exact_pairs(ray, settle, triangle);
  result.width = width;
  return result;
}

// Where the line surely passes through a corner. False if not.
bool settle_at_corner(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                      Settled& result) {
  const auto corner = meet_corner(ray, triangle, filtered);
  if (!corner) return false;
  result.hit = corner->hit;
  result.facing = corner->facing;
  result.zeros = corner->zeros;
  result.t = corner->t;
  result.certified = true;
  return true;
}

// What double is sure of, or came to without rounding. False if that is not enough.
bool settle_unrounded(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                      SureSigns& sure, Settled& result) {
  result.certified = true;
  result.t = sure.t;
  if (sure.in_range == false) return true;
  if (const auto along = look_along_axis(ray, triangle)) {
    const int den = along->den();
    const Interval& t = along->t;
    if (den == 0 || t.high < ray.t_min || t.low > ray.t_max) return true;
    if (sure.in_range || (t.low > ray.t_min && t.high < ray.t_max)) {
      if (!sure.den && is_infinite(result.t.low)) result.t = t;
      set_hit(den, along->u, along->v, along->w, result);
      return true;
    }
  }
  sure.complete(ray, triangle, filtered);
  result.certified = !sure.by_words;
  if (sure.den == 0 || sure.in_range == false) return true;
  if (sure.den && sure.in_range == true && sure.u && sure.v && sure.w) {
    const int den = *sure.den, u = den * *sure.u, v = den * *sure.v, w = den * *sure.w;
    if (u >= 0 && v >= 0 && w >= 0) set_hit(den, u, v, w, result);
    return true;
  }
  result.certified = false;
  return false;
}

Settled settle_hit(const RayD& ray, const TriangleD& triangle, const Filtered& filtered) {
  Settled result{};
  if (settle_at_corner(ray, triangle, filtered, result)) return result;
  SureSigns sure(ray, triangle, filtered);
  if (settle_unrounded(ray, triangle, filtered, sure, result)) return result;
  const auto settle = [&]<class Integer>(const Places& places) {
    if constexpr (std::is_same_v<Integer, exact::BigInt>) {
      if (filtered.usable) {
        const Filtered fine = filter_finely(ray, triangle, filtered);
        const Certified answer = certify_hit(fine, ray);
        if (answer == Certified::Yes) set_hit(fine.value.den < 0 ? -1 : 1, 1, 1, 1, result);
        result.t = t_interval(fine);
        result.certified = answer != Certified::Unsure;
        if (result.certified) return;
        sure = SureSigns(ray, triangle, fine);
      }
    }
    const auto parts = exact_parts<Integer>(ray, triangle, places);
    if (sure.den && sure.in_range == true) {
      settle_weights(parts, sure, result);
    } else {  // they need the normal, and the rest costs little more
      settle_all(ray, exact_pair(parts), result);
    }
  };
  const Width width = with_places(ray, settle, triangle);
  result.width = width;
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
  const auto round = [&]<class Integer>(const Places& places) {
    const auto parts = exact_parts<Integer>(ray, triangle, places);
    const auto n = cross(parts.e1, parts.e2);
    const auto den = dot(n, parts.d);
    const int den_sign = sign_of(den);
    const auto size = den_sign < 0 ? -den : den;
    const auto set = [&](std::uint8_t number, const auto& numerator, int place, Real& to) {
      if ((wanted & number) == 0) return;
      // What is hit has a plane that is crossed, unless a damaged file has it hit elsewhere.
      to = den_sign == 0
               ? Real{0}
               : exact::round_ratio<Real>(den_sign < 0 ? -numerator : numerator, size, place);
    };
    hit.facing = den_sign < 0 ? Facing::Front : Facing::Back;
    if ((wanted & kNumberT) != 0) set(kNumberT, dot(n, parts.s), parts.t_place, hit.t);
    if ((wanted & ~kNumberT) == 0) return;
    const auto r = cross(parts.d, parts.s);
    const auto u = -dot(r, parts.e2), v = dot(r, parts.e1);
    set(kNumberU, u, 0, hit.u);
    set(kNumberV, v, 0, hit.v);
    set(kNumberW, den - u - v, 0, hit.w);
  };
  with_places(ray, round, triangle);
}

template void settle_numbers<float>(const RayD&, const TriangleD&, std::uint8_t, Hit<float>&);
template void settle_numbers<double>(const RayD&, const TriangleD&, std::uint8_t, Hit<double>&);

}  // namespace pierce::predicate
