// SPDX-License-Identifier: Apache-2.0
//
// One ray, one triangle: the five determinants from which every answer is read off. One text for
// every kind of number: double, double-double, fixed-width and arbitrary-precision integers.
//
//   S = a - o,  E1 = b - a,  E2 = c - a,  N = E1 x E2,  R = d x S
//   den = N . d     U = -(R . E2)     V = R . E1     W = den - U - V     T = N . S
//
// Solving o + t d = a + u E1 + v E2 by taking the dot product with N, E2 x d and d x E1, each of
// which is at right angles to two of the three vectors, gives
//   t = T / den,  u = U / den,  v = V / den,  w = 1 - u - v = W / den.
//
// Source: the precomputed-normal form of Cramer's rule; Moeller & Trumbore 1997 for the sharing.
#pragma once

#include <cstddef>
#include <type_traits>

#include "exact/fixed_int.h"

namespace pierce::predicate {

/// Three numbers of any kind; products may be of a wider kind than their factors.
template <class Number>
struct Triple {
  Number x, y, z;
};

template <class Number>
Triple<Number> operator-(const Triple<Number>& p, const Triple<Number>& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

template <class Number>
Triple<Number> operator+(const Triple<Number>& p, const Triple<Number>& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}

template <class P, class Q>
auto cross(const Triple<P>& p, const Triple<Q>& q) {
  using Product = decltype(p.x * q.x);
  return Triple<Product>{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

template <class P, class Q>
auto dot(const Triple<P>& p, const Triple<Q>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}

// Of integers of fixed width: carried once.
template <std::size_t P, std::size_t Q>
Triple<exact::FixedInt<P + Q>> cross(const Triple<exact::FixedInt<P>>& p,
                                     const Triple<exact::FixedInt<Q>>& q) {
  return {exact::difference_of_products(p.y, q.z, p.z, q.y),
          exact::difference_of_products(p.z, q.x, p.x, q.z),
          exact::difference_of_products(p.x, q.y, p.y, q.x)};
}

template <std::size_t P, std::size_t Q>
exact::FixedInt<P + Q> dot(const Triple<exact::FixedInt<P>>& p,
                           const Triple<exact::FixedInt<Q>>& q) {
  return exact::sum_of_products(p.x, q.x, p.y, q.y, p.z, q.z);
}

/// `Mixed` numbers hold two lengths and a direction's component, `Lengths` three lengths.
template <class Mixed, class Lengths>
struct Determinants {
  Mixed den, u, v, w;
  Lengths t;
};

/// From the differences S, E1, E2 and the direction d.
template <class Length, class Direction>
auto determinants_of(const Triple<Length>& s, const Triple<Length>& e1, const Triple<Length>& e2,
                     const Triple<Direction>& d) {
  const auto n = cross(e1, e2);
  const auto r = cross(d, s);
  const auto den = dot(n, d);
  const auto u = -dot(r, e2);
  const auto v = dot(r, e1);
  const auto t = dot(n, s);
  using Mixed = std::remove_cvref_t<decltype(den)>;
  using Lengths = std::remove_cvref_t<decltype(t)>;
  return Determinants<Mixed, Lengths>{den, u, v, den - u - v, t};
}

}  // namespace pierce::predicate
