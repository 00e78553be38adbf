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
#include "support/finite.h"

namespace pierce::predicate {
namespace {

// Integers that cost more than double-doubles.
template <class Integer>
inline constexpr bool kIsDear =
    !std::is_same_v<Integer, exact::FixedInt<1>> && !std::is_same_v<Integer, exact::FixedInt<2>>;

// By the signs of its determinants.
void set_hit(int den, int u, int v, int w, Settled& result) {
  result.hit = true;
  result.facing = den < 0 ? Facing::Front : Facing::Back;
  result.zeros = static_cast<std::uint8_t>((u == 0 ? kZeroU : 0) | (v == 0 ? kZeroV : 0) |
                                           (w == 0 ? kZeroW : 0));
}

// What double may be sure of; nothing where it is not.
struct SureSigns {
  std::optional<int> den, u, v, w;  // the signs of the determinants
  std::optional<bool> in_range;     // if there is a hit
  Interval t;                       // of a hit, if that is known better than double knows it

  SureSigns() = default;
  SureSigns(const RayD& ray, const TriangleD& triangle, const Filtered& f) {
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

  // All that there is to know.
  [[nodiscard]] bool complete() const { return den && u && v && w && in_range == true; }

 private:
  static std::optional<int> sure(double value, double err) {
    if (value > err) return 1;
    if (value < -err) return -1;
    return {};
  }
};

// What double is not sure of.
template <class Integer>
void settle_rest(const RayD& ray, const ExactParts<Integer>& parts, const SureSigns& sure,
                 Settled& result) {
  int den = sure.den.value_or(0);
  const bool within = sure.in_range.value_or(false);
  if (den == 0 || !within) {
    const auto n = cross(parts.e1, parts.e2);
    const auto exact_den = [&] { return dot(n, parts.d); };
    if (den == 0) den = sign_of(exact_den());
    if (den == 0) return;
    if (!within) {
      const auto t = dot(n, parts.s);
      const auto from = [&](double bound) {
        return compare_t(t, exact_den, den, parts.t_place, bound);
      };
      const int start = from(ray.t_min);
      if (start < 0 || (start == 0 && ray.open_start) || from(ray.t_max) > 0) return;
    }
  }
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
  const auto settle = [&]<class Integer>(const Places& places) {
    settle_rest(ray, exact_parts<Integer>(ray, triangle, places), SureSigns(), result);
  };
  result.width = with_places(ray, settle, triangle);
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

// By what double is sure of, and what an axis makes simple. False if that is not enough.
bool settle_simply(const RayD& ray, const TriangleD& triangle, const SureSigns& sure,
                   Settled& result) {
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
  if (sure.complete()) {
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
  if (settle_simply(ray, triangle, sure, result)) return result;
  const auto settle = [&]<class Integer>(const Places& places) {
    if constexpr (kIsDear<Integer>) {
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
    settle_rest(ray, exact_parts<Integer>(ray, triangle, places), sure, result);
  };
  result.width = with_places(ray, settle, triangle);
  return result;
}

bool settle_has_area(const TriangleD& triangle) {
  bool area = false;
  const RayD none{triangle.a, {1, 0, 0}};
  const auto settle = [&]<class Integer>(const Places& places) {
    const auto parts = exact_parts<Integer>(none, triangle, places);
    const auto n = cross(parts.e1, parts.e2);
    area = sign_of(n.x) != 0 || sign_of(n.y) != 0 || sign_of(n.z) != 0;
  };
  with_places(none, settle, triangle);
  return area;
}

std::strong_ordering settle_order(const RayD& ray, const TriangleD& first,
                                  const TriangleD& second) {
  int sign = 0;
  const auto compare = [&]<class Integer>(const Places& places) {
    const auto p = exact_parts<Integer>(ray, first, places);
    const auto q = exact_parts<Integer>(ray, second, places);
    const auto p_normal = cross(p.e1, p.e2), q_normal = cross(q.e1, q.e2);
    const auto p_den = dot(p_normal, p.d), q_den = dot(q_normal, q.d);
    // Both places are the same.
    sign = sign_of(p_den) * sign_of(q_den) *
           compare_scaled(dot(p_normal, p.s) * q_den, 0, dot(q_normal, q.s) * p_den);
  };
  with_places(ray, compare, first, second);
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
