// SPDX-License-Identifier: Apache-2.0
#include "predicate/nearest.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "predicate/bounds.h"
#include "predicate/nearest_formulas.h"
#include "predicate/round_bounded.h"
#include "predicate/settle_nearest.h"
#include "predicate/towards_triangle.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

using exact::Bounded;
using exact::DoubleDouble;

Bounded<double> exactly(double a, double) { return {a, 0}; }
Bounded<DoubleDouble> exactly(double a, const DoubleDouble&) { return {{a, 0}, 0}; }

template <class T>
PointAndTriangle<Bounded<T>> bounded_parts(const Vec3<double>& p, const TriangleD& t) {
  const Triple<Bounded<T>> a{exactly(t.a.x, T{}), exactly(t.a.y, T{}), exactly(t.a.z, T{})};
  return {a,
          bounded_difference<T>(p, t.a),
          bounded_difference<T>(p, t.b),
          bounded_difference<T>(p, t.c),
          bounded_difference<T>(t.b, t.a),
          bounded_difference<T>(t.c, t.a)};
}

template <class T>
const Triple<T>* corner(const PointAndTriangle<T>& t, Feature feature) {
  switch (feature) {
    case Feature::VertexA:
      return &t.from_a;
    case Feature::VertexB:
      return &t.from_b;
    case Feature::VertexC:
      return &t.from_c;
    default:
      return nullptr;
  }
}

template <class T>
Bounded<T> squared_distance(const PointAndTriangle<Bounded<T>>& t, Feature feature) {
  if (const auto* from = corner(t, feature)) return dot(*from, *from);
  return with_squared_distance(t, feature, [](const auto& n, const auto& d) { return n / d; });
}

Interval interval_of(const Bounded<double>& x) {
  const double low = x.value - x.err;
  const double high = x.value + x.err;
  if (!(low <= high) || is_infinite(high)) return {};
  // One rounding each.
  return {low - 0x1p-52 * std::fabs(low), high + 0x1p-52 * std::fabs(high)};
}

// The two corners of an edge, or the corner twice.
struct Support {
  const Vec3<double>*p, *q;
};
std::optional<Support> support_of(const NearTriangle& near) {
  const TriangleD& t = near.triangle;
  switch (near.feature) {
    case Feature::VertexA:
      return Support{&t.a, &t.a};
    case Feature::VertexB:
      return Support{&t.b, &t.b};
    case Feature::VertexC:
      return Support{&t.c, &t.c};
    case Feature::EdgeAB:
      return Support{&t.a, &t.b};
    case Feature::EdgeBC:
      return Support{&t.b, &t.c};
    case Feature::EdgeCA:
      return Support{&t.c, &t.a};
    case Feature::Face:
      return std::nullopt;
  }
  return std::nullopt;
}

// Two triangles that share the edge or the corner that is nearest are equally near.
bool share_nearest(const NearTriangle& first, const NearTriangle& second) {
  const auto one = support_of(first);
  const auto other = support_of(second);
  if (!one || !other) return false;
  return (*one->p == *other->p && *one->q == *other->q) ||
         (*one->p == *other->q && *one->q == *other->p);
}

// Whether every point of the triangle's feature has the same coordinate here.
bool is_flat(double a, double b, double c) { return a == b && b == c; }

template <class T, class Real>
bool round_distance(const PointAndTriangle<Bounded<T>>& t, Feature feature, Real& distance) {
  return round_bounded(square_root(squared_distance(t, feature)), distance);
}

// The nearest point and its weights; the feature that holds it is no corner.
template <class T, class Real>
bool round_point(const PointAndTriangle<Bounded<T>>& t, const NearTriangle& near,
                 NearestPoint<Real>& result) {
  bool sure = false;
  const auto numbers = [&](const auto& wa, const auto& wb, const auto& wc, const auto& sum) {
    const auto along = [&](const auto& a, const auto& e1, const auto& e2, Real& x) {
      return round_bounded((a * sum + wb * e1 + wc * e2) / sum, x);
    };
    const TriangleD& tri = near.triangle;
    const auto coordinate = [&](double a, double b, double c, const auto& a_b, const auto& e1,
                                const auto& e2, Real& x) {
      if (!is_flat(a, b, c)) return along(a_b, e1, e2, x);
      x = plus_zero<Real>(a);
      return true;
    };
    sure = round_bounded(wa / sum, result.w) && round_bounded(wb / sum, result.u) &&
           round_bounded(wc / sum, result.v) &&
           coordinate(tri.a.x, tri.b.x, tri.c.x, t.a.x, t.e1.x, t.e2.x, result.point.x) &&
           coordinate(tri.a.y, tri.b.y, tri.c.y, t.a.y, t.e1.y, t.e2.y, result.point.y) &&
           coordinate(tri.a.z, tri.b.z, tri.c.z, t.a.z, t.e1.z, t.e2.z, result.point.z);
  };
  with_weights(t, projections_of(t), near.feature, numbers);
  return sure;
}

}  // namespace

NearTriangle decide_near(const Vec3<double>& point, const TriangleD& triangle,
                         LadderCounts& counts) {
  NearTriangle near{triangle, Feature::Face, {}};
  const auto parts = bounded_parts<double>(point, triangle);
  if (const auto feature = feature_of(projections_of(parts))) {
    near.feature = *feature;
    ++counts.certified;
  } else {
    const SettledFeature settled = settle_feature(point, triangle);
    near.feature = settled.feature;
    ++(settled.width == Width::Any ? counts.settled_big : counts.settled);
  }
  near.squared = interval_of(squared_distance(parts, near.feature));
  return near;
}

bool surely_farther(const Vec3<double>& point, const NearTriangle& known,
                    const TriangleD& triangle) {
  const Vec3<double> a = triangle.a - point;
  const Vec3<double> b = triangle.b - point;
  const Vec3<double> c = triangle.c - point;
  const Vec3<double> g = towards_triangle(a, b, c);
  // As in the traversal in double, but for copies. Vectors are not so short that underflow matters,
  // and nothing is said of those that are so long that products might overflow.
  const double reach = std::max({max_norm(a), max_norm(b), max_norm(c)});
  const double low = std::min({dot(g, a), dot(g, b), dot(g, c)}) / std::sqrt(dot(g, g)) -
                     bounds::kNearestPlainReach * reach;
  return reach < 0x1p500 && low > 0 &&
         low * low * (1 - 0x1p-50) > std::max(known.squared.high, exact::Loss<double>::kUnderflow);
}

std::optional<NearTriangle> near_in_same_corner(const Vec3<double>& point,
                                                const NearTriangle& known,
                                                const TriangleD& triangle) {
  const auto support = support_of(known);
  if (!support || support->p != support->q) return std::nullopt;
  const Vec3<double>& x = *support->p;
  const Vec3<double>* const corners[3] = {&triangle.a, &triangle.b, &triangle.c};
  constexpr Feature kFeatures[3] = {Feature::VertexA, Feature::VertexB, Feature::VertexC};
  const auto from = bounded_difference<double>(point, x);
  const auto is_behind = [&](const Vec3<double>& end) {
    return is_positive(dot(bounded_difference<double>(end, x), from)) == Certified::No;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (*corners[i] != x) continue;
    if (!is_behind(*corners[(i + 1) % 3]) || !is_behind(*corners[(i + 2) % 3])) break;
    return NearTriangle{triangle, kFeatures[i], known.squared};
  }
  return std::nullopt;
}

std::strong_ordering decide_nearer(const Vec3<double>& point, const NearTriangle& first,
                                   const NearTriangle& second, LadderCounts& counts) {
  if (first.squared.high < second.squared.low || second.squared.high < first.squared.low) {
    ++counts.orders_certified;
    return first.squared.high < second.squared.low ? std::strong_ordering::less
                                                   : std::strong_ordering::greater;
  }
  ++counts.orders_settled;
  if (share_nearest(first, second)) return std::strong_ordering::equal;
  return settle_nearer(point, first, second);
}

bool decide_within(const Vec3<double>& point, const NearTriangle& near, double radius,
                   LadderCounts& counts) {
  if (is_infinite(radius)) return true;
  const double square = radius * radius;
  // The square is rounded once, or far below the smallest normal number.
  const bool sure = is_finite_number(square) && square > 0x1p-900;
  if (sure && near.squared.high < square * (1 - 0x1p-52)) return true;
  if (sure && near.squared.low > square * (1 + 0x1p-52)) return false;
  ++counts.orders_settled;
  return compare_distance(point, near, radius) <= 0;
}

template <class Real>
NearestPoint<Real> round_nearest(const Vec3<double>& point, const NearTriangle& near,
                                 LadderCounts& counts) {
  using Finer = std::conditional_t<std::is_same_v<Real, float>, double, DoubleDouble>;
  NearestPoint<Real> result;
  result.feature = near.feature;
  if (const auto support = support_of(near); support && support->p == support->q) {
    const Vec3<double>& x = *support->p;
    result.point = {plus_zero<Real>(x.x), plus_zero<Real>(x.y), plus_zero<Real>(x.z)};
    (near.feature == Feature::VertexA   ? result.w
     : near.feature == Feature::VertexB ? result.u
                                        : result.v) = 1;
  }
  const auto t = bounded_parts<Finer>(point, near.triangle);
  const bool sure_of_distance = round_distance(t, near.feature, result.distance);
  const bool sure_of_point = corner(t, near.feature) != nullptr || round_point(t, near, result);
  if (sure_of_distance && sure_of_point) [[likely]]
    return result;
  ++counts.rounded_exactly;
  if (!sure_of_distance) result.distance = settle_distance<Real>(point, near);
  if (!sure_of_point) settle_nearest(point, near, result);
  return result;
}

template NearestPoint<float> round_nearest<float>(const Vec3<double>&, const NearTriangle&,
                                                  LadderCounts&);
template NearestPoint<double> round_nearest<double>(const Vec3<double>&, const NearTriangle&,
                                                    LadderCounts&);

}  // namespace pierce::predicate
