// SPDX-License-Identifier: Apache-2.0
//
// One point p, one triangle: which feature of the triangle holds the point X nearest to p, and the
// numbers of X as fractions. One text for every kind of number: bounded doubles and double-doubles,
// fixed-width and arbitrary-precision integers.
//
//   E1 = b - a,  E2 = c - a,  and for each corner q  1_q = E1 . (p - q),  2_q = E2 . (p - q)
//   wc = 1_a 2_b - 1_b 2_a    wb = 1_c 2_a - 1_a 2_c    wa = 1_b 2_c - 1_c 2_b
//
// wa, wb, wc are |N|^2 times the weights of the foot of the perpendicular from p to the plane. X is
// a corner iff p is on no side of it that leads into the triangle; it is inside an edge iff p is
// over the edge and the third corner's weight, for the foot on the edge, is not positive; else X is
// that foot. These are the optimality conditions of a convex problem, so they hold for triangles
// without area as well, and one of them always does.
//
// Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5, with what degenerate
// triangles need.
#pragma once

#include <optional>

#include "exact/big_int.h"
#include "exact/bounded.h"
#include "exact/fixed_int.h"
#include "pierce/nearest.h"
#include "predicate/determinants.h"
#include "predicate/types.h"

namespace pierce::predicate {

using exact::sign_of;

/// Whether a number is greater than zero.
inline Certified is_positive(const exact::BigInt& x) { return certified(sign_of(x) > 0); }
template <std::size_t N>
Certified is_positive(const exact::FixedInt<N>& x) {
  return certified(sign_of(x) > 0);
}
inline Certified is_positive(const exact::Bounded<double>& x) {
  // Differences of two numbers have the right sign, and what has overflowed makes NaN.
  if (x.value - x.err > 0) return Certified::Yes;
  return x.value + x.err <= 0 ? Certified::No : Certified::Unsure;
}

/// The differences that everything is made of.
template <class Length>
struct PointAndTriangle {
  Triple<Length> a;                       // the corner itself
  Triple<Length> from_a, from_b, from_c;  // p - a, p - b, p - c
  Triple<Length> e1, e2;
};

/// E1 and E2 times the point as seen from each corner.
template <class Area>
struct Projections {
  Area e1_a, e2_a, e1_b, e2_b, e1_c, e2_c;
};

template <class Length>
auto projections_of(const PointAndTriangle<Length>& t) {
  using Area = decltype(dot(t.e1, t.from_a));
  return Projections<Area>{dot(t.e1, t.from_a), dot(t.e2, t.from_a), dot(t.e1, t.from_b),
                           dot(t.e2, t.from_b), dot(t.e1, t.from_c), dot(t.e2, t.from_c)};
}

template <class Area>
auto weight_a(const Projections<Area>& d) {
  return d.e1_b * d.e2_c - d.e1_c * d.e2_b;
}
template <class Area>
auto weight_b(const Projections<Area>& d) {
  return d.e1_c * d.e2_a - d.e1_a * d.e2_c;
}
template <class Area>
auto weight_c(const Projections<Area>& d) {
  return d.e1_a * d.e2_b - d.e1_b * d.e2_a;
}

/// The feature that holds X; nothing if a sign that matters is not sure.
template <class Area>
std::optional<Feature> feature_of(const Projections<Area>& d) {
  struct Case {
    Certified holds;
    Feature feature;
  };
  const auto positive = [](const auto& x) { return is_positive(x); };
  const auto negative = [](const auto& x) { return is_positive(-x); };
  const auto no = [](Certified x) {
    return x == Certified::Unsure ? x : certified(x == Certified::No);
  };
  const auto both = [](Certified x, Certified y) {
    if (x == Certified::No || y == Certified::No) return Certified::No;
    return x == Certified::Yes && y == Certified::Yes ? Certified::Yes : Certified::Unsure;
  };
  // As seen from a corner, the next corner's side: along each of the six directed edges.
  const Certified a_to_b = positive(d.e1_a);
  const Certified a_to_c = positive(d.e2_a);
  const Certified b_to_a = negative(d.e1_b);
  const Certified b_to_c = positive(d.e2_b - d.e1_b);
  const Certified c_to_a = negative(d.e2_c);
  const Certified c_to_b = positive(d.e1_c - d.e2_c);

  const auto corner = [&](Certified one, Certified other) { return both(no(one), no(other)); };
  const Case corners[] = {{corner(a_to_b, a_to_c), Feature::VertexA},
                          {corner(b_to_a, b_to_c), Feature::VertexB},
                          {corner(c_to_a, c_to_b), Feature::VertexC}};
  for (const Case& c : corners) {
    if (c.holds == Certified::Unsure) return std::nullopt;
    if (c.holds == Certified::Yes) return c.feature;
  }
  // Inside an edge: p is over it, and the foot on it is no worse than what lies towards the third
  // corner.
  const auto edge = [&](Certified one, Certified other, const auto& weight) {
    const Certified over = both(one, other);
    return over == Certified::No ? over : both(over, no(positive(weight(d))));
  };
  const Case edges[] = {
      {edge(a_to_b, b_to_a, [](const auto& x) { return weight_c(x); }), Feature::EdgeAB},
      {edge(b_to_c, c_to_b, [](const auto& x) { return weight_a(x); }), Feature::EdgeBC},
      {edge(c_to_a, a_to_c, [](const auto& x) { return weight_b(x); }), Feature::EdgeCA}};
  for (const Case& c : edges) {
    if (c.holds == Certified::Unsure) return std::nullopt;
    if (c.holds == Certified::Yes) return c.feature;
  }
  return Feature::Face;
}

/// Calls `use(numerator, denominator)` with the squared distance |p - X|^2 as a fraction; the
/// feature holds X and is not a corner.
template <class Length, class Use>
auto with_squared_distance(const PointAndTriangle<Length>& t, Feature feature, const Use& use) {
  const auto edge = [&use](const Triple<Length>& e, const Triple<Length>& from) {
    const auto area = cross(e, from);
    return use(dot(area, area), dot(e, e));
  };
  if (feature == Feature::EdgeAB) return edge(t.e1, t.from_a);
  if (feature == Feature::EdgeBC) return edge(t.e2 - t.e1, t.from_b);
  if (feature == Feature::EdgeCA) return edge(t.e2, t.from_a);
  const auto n = cross(t.e1, t.e2);
  const auto volume = dot(n, t.from_a);
  return use(volume * volume, dot(n, n));
}

/// Calls `use(wa, wb, wc, sum)` with the weights of X times their sum, zeros being exactly zero;
/// the feature holds X and is not a corner.
template <class Length, class Area, class Use>
void with_weights(const PointAndTriangle<Length>& t, const Projections<Area>& d, Feature feature,
                  const Use& use) {
  const Area zero{};
  if (feature == Feature::EdgeAB) {
    use(-d.e1_b, d.e1_a, zero, dot(t.e1, t.e1));
  } else if (feature == Feature::EdgeBC) {
    const auto e = t.e2 - t.e1;
    use(zero, d.e1_c - d.e2_c, d.e2_b - d.e1_b, dot(e, e));
  } else if (feature == Feature::EdgeCA) {
    use(-d.e2_c, zero, d.e2_a, dot(t.e2, t.e2));
  } else {
    const auto n = cross(t.e1, t.e2);
    use(weight_a(d), weight_b(d), weight_c(d), dot(n, n));
  }
}

}  // namespace pierce::predicate
