// SPDX-License-Identifier: Apache-2.0
//
// How wide it gets, for coordinates of L = 62 N - 3 bits: differences are below 2^(L + 1), e2 - e1
// below 2^(L + 2); what has two lengths is below 2^(2L + 6), four lengths 2^(4L + 10), the square
// of the volume 2^(6L + 12). Digits hold 2L + 7, 4L + 13 and 6L + 19 bits besides the sign, and 10L
// + 31 for the products of ten lengths by which squared distances are compared. A coordinate of the
// nearest point has five lengths: below 2^(5L + 14), where digits hold 5L + 16.
#include "predicate/settle_nearest.h"

#include <type_traits>

#include "exact/round_fixed.h"
#include "exact/round_ratio.h"
#include "exact/scaled_integers.h"
#include "predicate/exact_pair.h"
#include "predicate/nearest_formulas.h"

namespace pierce::predicate {
namespace {

using exact::BigInt;
using exact::FixedInt;

const Vec3<double>& corner_of(const NearTriangle& near) {
  if (near.feature == Feature::VertexA) return near.triangle.a;
  return near.feature == Feature::VertexB ? near.triangle.b : near.triangle.c;
}

bool at_corner(Feature feature) {
  return feature == Feature::VertexA || feature == Feature::VertexB || feature == Feature::VertexC;
}

template <class Integer>
PointAndTriangle<Integer> integers(const Vec3<double>& point, const TriangleD& t, int place) {
  const auto p = scaled_triple<Integer>(point, place);
  const auto a = scaled_triple<Integer>(t.a, place);
  const auto b = scaled_triple<Integer>(t.b, place);
  const auto c = scaled_triple<Integer>(t.c, place);
  return {a, p - a, p - b, p - c, b - a, c - a};
}

// Calls `use.operator()<Integer>(place)` with the integers that hold all the numbers.
template <class Use, class... Triangles>
Width with_place(const Vec3<double>& point, const Use& use, const Triangles&... triangles) {
  const auto from_places = [&]<class Integer>(const Places& places) {
    use.template operator()<Integer>(places.points.empty() ? 0 : places.points.low);
  };
  return with_places(RayD{point, {1, 0, 0}}, from_places, triangles...);
}

// The kinds of number that hold products of six and of four lengths.
template <class Integer>
struct Wide;
template <std::size_t N>
struct Wide<FixedInt<N>> {
  using Six = FixedInt<6 * N>;
  using Four = FixedInt<4 * N>;
  static Four one() { return {{1}}; }
  template <std::size_t M>
  static Six six(const FixedInt<M>& x) {
    return exact::widened<6 * N>(x);
  }
  template <std::size_t M>
  static Four four(const FixedInt<M>& x) {
    return exact::widened<4 * N>(x);
  }
};
template <>
struct Wide<BigInt> {
  using Six = BigInt;
  using Four = BigInt;
  static BigInt one() { return 1; }
  static const BigInt& six(const BigInt& x) { return x; }
  static const BigInt& four(const BigInt& x) { return x; }
};

// The squared distance as a fraction, in units of 2^(2 place).
template <class Integer>
struct Squared {
  typename Wide<Integer>::Six numerator;
  typename Wide<Integer>::Four denominator;
};

template <class Integer>
Squared<Integer> squared_distance(const Vec3<double>& point, const NearTriangle& near, int place) {
  using Wider = Wide<Integer>;
  if (at_corner(near.feature)) {
    const auto s =
        scaled_triple<Integer>(point, place) - scaled_triple<Integer>(corner_of(near), place);
    return {Wider::six(dot(s, s)), Wider::one()};
  }
  const auto fraction = [](const auto& numerator, const auto& denominator) {
    return Squared<Integer>{Wider::six(numerator), Wider::four(denominator)};
  };
  return with_squared_distance(integers<Integer>(point, near.triangle, place), near.feature,
                               fraction);
}

}  // namespace

SettledFeature settle_feature(const Vec3<double>& point, const TriangleD& triangle) {
  SettledFeature result{};
  const auto find = [&]<class Integer>(int place) {
    const auto parts = integers<Integer>(point, triangle, place);
    result.feature = *feature_of(projections_of(parts));
  };
  result.width = with_place(point, find, triangle);
  return result;
}

std::strong_ordering settle_nearer(const Vec3<double>& point, const NearTriangle& first,
                                   const NearTriangle& second) {
  int sign = 0;
  const auto compare = [&]<class Integer>(int place) {
    const auto p = squared_distance<Integer>(point, first, place);
    const auto q = squared_distance<Integer>(point, second, place);
    sign = compare_scaled(p.numerator * q.denominator, 0, q.numerator * p.denominator);
  };
  with_place(point, compare, first.triangle, second.triangle);
  return sign <=> 0;
}

std::strong_ordering compare_distance(const Vec3<double>& point, const NearTriangle& near,
                                      double radius) {
  int sign = 0;
  const exact::BinaryParts parts = exact::binary_parts(radius);
  const auto compare = [&]<class Integer>(int place) {
    const auto squared = squared_distance<Integer>(point, near, place);
    const auto m = exact::integer_like(squared.denominator, parts.significand);
    sign = compare_scaled(squared.numerator, 2 * (place - parts.exponent),
                          squared.denominator * (m * m));
  };
  with_place(point, compare, near.triangle);
  return sign <=> 0;
}

template <class Real>
Real settle_distance(const Vec3<double>& point, const NearTriangle& near) {
  Real distance = 0;
  const auto round = [&]<class Integer>(int place) {
    const auto squared = squared_distance<Integer>(point, near, place);
    distance = exact::round_root<Real>(squared.numerator, squared.denominator, place);
  };
  with_place(point, round, near.triangle);
  return distance;
}

template <class Real>
void settle_nearest(const Vec3<double>& point, const NearTriangle& near,
                    NearestPoint<Real>& result) {
  const auto round = [&]<class Integer>(int place) {
    const auto t = integers<Integer>(point, near.triangle, place);
    const auto numbers = [&](const auto& wa, const auto& wb, const auto& wc, const auto& sum) {
      using Weight = std::decay_t<decltype(sum)>;
      const auto along = [&](const Integer& a, const Integer& e1, const Integer& e2) {
        const auto coordinate = dot(Triple<Integer>{a, e1, e2}, Triple<Weight>{sum, wb, wc});
        return exact::round_ratio<Real>(coordinate, sum, place);
      };
      result.point = {along(t.a.x, t.e1.x, t.e2.x), along(t.a.y, t.e1.y, t.e2.y),
                      along(t.a.z, t.e1.z, t.e2.z)};
      result.w = exact::round_ratio<Real>(wa, sum, 0);
      result.u = exact::round_ratio<Real>(wb, sum, 0);
      result.v = exact::round_ratio<Real>(wc, sum, 0);
    };
    with_weights(t, projections_of(t), near.feature, numbers);
  };
  with_place(point, round, near.triangle);
}

template float settle_distance<float>(const Vec3<double>&, const NearTriangle&);
template double settle_distance<double>(const Vec3<double>&, const NearTriangle&);
template void settle_nearest(const Vec3<double>&, const NearTriangle&, NearestPoint<float>&);
template void settle_nearest(const Vec3<double>&, const NearTriangle&, NearestPoint<double>&);

}  // namespace pierce::predicate
