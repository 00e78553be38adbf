// SPDX-License-Identifier: Apache-2.0
#include "predicate/place.h"

#include <type_traits>

#include "exact/round_ratio.h"
#include "predicate/exact_pair.h"
#include "predicate/filtered.h"
#include "predicate/round_bounded.h"

namespace pierce::predicate {
namespace {

using exact::BigInt;
using exact::Bounded;
using exact::DoubleDouble;

// t of the line, with the bounds of the double rung.
Bounded<double> bounded_t(const RayD&, const TriangleD&, const Filtered& f, double) {
  return Bounded<double>{f.value.t, f.t_err} / Bounded<double>{f.value.den, f.den_err};
}
Bounded<DoubleDouble> bounded_t(const RayD& ray, const TriangleD& t, const Filtered& f,
                                DoubleDouble) {
  const auto difference = [](const Vec3<double>& p, const Vec3<double>& q) {
    return Triple<DoubleDouble>{exact::two_sum(p.x, -q.x), exact::two_sum(p.y, -q.y),
                                exact::two_sum(p.z, -q.z)};
  };
  const auto n = cross(difference(t.b, t.a), difference(t.c, t.a));
  const Triple<double> d{ray.direction.x, ray.direction.y, ray.direction.z};
  return Bounded<DoubleDouble>{dot(n, difference(t.a, ray.origin)), f.t_err * bounds::kFiner} /
         Bounded<DoubleDouble>{dot(n, d), f.den_err * bounds::kFiner};
}

Bounded<double> bounded_exact(double a, double) { return {a, 0}; }
Bounded<DoubleDouble> bounded_exact(double a, DoubleDouble) { return {{a, 0}, 0}; }

// o + t d, unless it is known: what the ray, or the triangle, does not change.
template <class T, class Real>
bool coordinate(const Bounded<T>& t, double o, double d, double a, double b, double c, Real& x) {
  if (d == 0 || (a == b && a == c)) {
    x = plus_zero<Real>(d == 0 ? o : a);
    return true;
  }
  return round_bounded(bounded_exact(o, T{}) + t * bounded_exact(d, T{}), x);
}

template <class T, class Real>
bool point_certified(const RayD& ray, const TriangleD& tri, const Filtered& f, Vec3<Real>& x) {
  const Bounded<T> t = bounded_t(ray, tri, f, T{});
  const Vec3<double>& o = ray.origin;
  const Vec3<double>& d = ray.direction;
  return coordinate(t, o.x, d.x, tri.a.x, tri.b.x, tri.c.x, x.x) &&
         coordinate(t, o.y, d.y, tri.a.y, tri.b.y, tri.c.y, x.y) &&
         coordinate(t, o.z, d.z, tri.a.z, tri.b.z, tri.c.z, x.z);
}

// (o den + T d) / den.
template <class Real>
Vec3<Real> point_exactly(const RayD& ray, const TriangleD& triangle) {
  Places places(ray);
  places.include(triangle);
  const int place = places.points.empty() ? 0 : places.points.low;
  const auto parts = exact_parts<BigInt>(ray, triangle, places);
  const auto pair = exact_pair(parts);
  const auto o = scaled_triple<BigInt>(ray.origin, place);
  const auto round = [&](const BigInt& origin, const BigInt& direction) {
    return exact::round_ratio<Real>(origin * pair.value.den + direction * pair.value.t,
                                    pair.value.den, place);
  };
  return {round(o.x, parts.d.x), round(o.y, parts.d.y), round(o.z, parts.d.z)};
}

template <class T>
Triple<Bounded<T>> bounded_normal(const TriangleD& t) {
  return cross(bounded_difference<T>(t.b, t.a), bounded_difference<T>(t.c, t.a));
}

template <class T, class Real>
bool normal_certified(const TriangleD& t, Vec3<Real>& result) {
  const auto n = bounded_normal<T>(t);
  return round_bounded(n.x, result.x) && round_bounded(n.y, result.y) &&
         round_bounded(n.z, result.z);
}

template <class T, class Real>
bool unit_certified(const TriangleD& t, Vec3<Real>& result) {
  const auto n = bounded_normal<T>(t);
  const Bounded<T> length = square_root(dot(n, n));
  const auto component = [&](const Bounded<T>& along, Real& x) {
    return round_bounded(along / length, x);
  };
  return component(n.x, result.x) && component(n.y, result.y) && component(n.z, result.z);
}

// N in units of 2^(2 place).
struct ExactNormal {
  Triple<BigInt> n;
  int place;

  explicit ExactNormal(const TriangleD& t) {
    Places places(RayD{t.a, {1, 0, 0}});
    places.include(t);
    place = places.points.empty() ? 0 : places.points.low;
    const auto a = scaled_triple<BigInt>(t.a, place);
    n = cross(scaled_triple<BigInt>(t.b, place) - a, scaled_triple<BigInt>(t.c, place) - a);
  }
};

}  // namespace

template <class Real>
Vec3<Real> round_point(const RayD& ray, const TriangleD& triangle) {
  Vec3<Real> x{};
  const Filtered f = filter_determinants(ray, triangle);
  if (f.usable) {
    if constexpr (std::is_same_v<Real, float>) {
      if (point_certified<double>(ray, triangle, f, x)) return x;
    }
    if (point_certified<DoubleDouble>(ray, triangle, f, x)) return x;
  }
  return point_exactly<Real>(ray, triangle);
}

template <class Real>
Vec3<Real> round_normal(const TriangleD& triangle) {
  Vec3<Real> result{};
  if constexpr (std::is_same_v<Real, float>) {
    if (normal_certified<double>(triangle, result)) return result;
  }
  if (normal_certified<DoubleDouble>(triangle, result)) return result;
  const ExactNormal exact(triangle);
  const auto round = [&](const BigInt& x) {
    return exact::round_ratio<Real>(x, 1, 2 * exact.place);
  };
  return {round(exact.n.x), round(exact.n.y), round(exact.n.z)};
}

template <class Real>
Vec3<Real> round_unit_normal(const TriangleD& triangle) {
  Vec3<Real> result{};
  if constexpr (std::is_same_v<Real, float>) {
    if (unit_certified<double>(triangle, result)) return result;
  }
  if (unit_certified<DoubleDouble>(triangle, result)) return result;
  const Triple<BigInt> n = ExactNormal(triangle).n;
  const BigInt square = dot(n, n);
  if (sign_of(square) == 0) return {};
  const auto round = [&](const BigInt& x) {
    const Real size = exact::round_root<Real>(x * x, square, 0);
    return x.sign() < 0 && size != 0 ? -size : size;
  };
  return {round(n.x), round(n.y), round(n.z)};
}

template Vec3<float> round_point<float>(const RayD&, const TriangleD&);
template Vec3<double> round_point<double>(const RayD&, const TriangleD&);
template Vec3<float> round_normal<float>(const TriangleD&);
template Vec3<double> round_normal<double>(const TriangleD&);
template Vec3<float> round_unit_normal<float>(const TriangleD&);
template Vec3<double> round_unit_normal<double>(const TriangleD&);

}  // namespace pierce::predicate
