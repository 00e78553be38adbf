// SPDX-License-Identifier: Apache-2.0
//
// The cull: lanes of rays against lanes of triangles, in float. Three answers a lane: discarded
// (surely no hit), certain (surely a hit, tau in an interval), or open (for the resolver to
// decide).
//
// Key: S = a - o, E1 = b - a, E2 = c - a, R = d x S, N = E1 x E2;
//      den = N.d, U = -(R.E2), V = R.E1, T = N.S; hit iff U, V, den - U - V >= 0 (signs by den)
//      and T / den = tau in range. The bounds are those of predicate/bounds.h, derived in
//      docs/algorithm.md ("The leaf cull", "The place in the order").
#if defined(PIERCE_KERNELS_CULL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_CULL_INL_H_
#undef PIERCE_KERNELS_CULL_INL_H_
#else
#define PIERCE_KERNELS_CULL_INL_H_
#endif

#include <cstddef>

#include "kernels/bounds.h"
#include "kernels/vectors-inl.h"
#include "pierce/options.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// The bounds of one leaf and ray: the constants of bounds.h times its largest edge component, at
// the larger reach of the two.
struct LeafBounds {
  float e, sum_e, tau_input, tau_rest;
  Sides sides;  // that the ray sees
};

HWY_INLINE LeafBounds leaf_bounds(float edge, float reach, bool exact, Sides sides) {
  const float e = edge * (kEdgeLinear * reach + kEdgeSquare * edge) + kEdgeFloor * (reach * reach);
  const float inexact = exact ? 0 : reach;
  return {e, kSumFactor * e, kTauInput * inexact,
          edge * edge * (kTauCube * edge + kTauSquare * inexact) + kTauFloor, sides};
}

// Of a ray that is blurred.
HWY_INLINE LeafBounds blurred(LeafBounds bounds, float edge, float blur) {
  bounds.e += blur * (kBlurEdge * edge + kBlurSquare * blur);
  bounds.sum_e = kSumFactor * bounds.e;
  bounds.tau_rest += kBlurTau * blur * (edge * edge);
  return bounds;
}

// The sign by which u, v and w are told from those of a miss: that of den, or, if only one side is
// seen, the one that den has there. Then den, u, v and w of the other side cannot all be positive,
// and it is discarded like any miss.
template <class D>
HWY_INLINE hn::Vec<D> sign_of_side(D d, hn::Vec<D> den, Sides sides) {
  static constexpr float kOwn[3] = {-0.0F, 0, 0}, kFixed[3] = {0, -0.0F, 0};  // front: den < 0
  static_assert(static_cast<int>(Sides::Front) == 1 && static_cast<int>(Sides::Back) == 2);
  const auto side = static_cast<std::size_t>(sides);
  using Number = hn::TFromD<D>;
  const auto own = hn::Set(d, static_cast<Number>(kOwn[side]));
  return hn::Or(hn::And(den, own), hn::Set(d, static_cast<Number>(kFixed[side])));
}

template <class D>
class Cull {
 public:
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  HWY_INLINE Cull(const V3<V>& a, const V3<V>& b, const V3<V>& c, const V3<V>& origin,
                  const V3<V>& direction, const LeafBounds& bounds)
      : bounds_(bounds), s_(a - origin) {
    const V3<V> e1 = b - a;
    const V3<V> e2 = c - a;
    n_ = cross(e1, e2);
    const V3<V> r = cross(direction, s_);
    const V den = dot(n_, direction);
    sign_ = sign_of_side(D(), den, bounds.sides);
    den_ = hn::Xor(den, sign_);
    u_ = hn::Xor(hn::Neg(dot(r, e2)), sign_);
    v_ = hn::Xor(dot(r, e1), sign_);
    w_ = hn::Sub(hn::Sub(den_, u_), v_);
  }

  /// Lanes that the edges do not discard.
  [[nodiscard]] HWY_INLINE M open() const {
    const D d;
    const V minus_e = hn::Set(d, -bounds_.e);
    const M uv = hn::And(hn::Ge(u_, minus_e), hn::Ge(v_, minus_e));
    return hn::And(uv, hn::Ge(w_, hn::Set(d, -bounds_.sum_e)));
  }

  /// Computes the interval of tau. Call before in_range, certain, low and high.
  HWY_INLINE void compute_tau() {
    const D d;
    const V inverse = hn::Div(hn::Set(d, 1.0F), den_);
    const V tau = hn::Mul(hn::Xor(dot(n_, s_), sign_), inverse);
    const V reach = hn::MulAdd(hn::Set(d, kTauReach), max_norm(s_), hn::Set(d, bounds_.tau_input));
    const V err = hn::Mul(hn::MulAdd(max_norm(n_), reach, hn::Set(d, bounds_.tau_rest)), inverse);
    low_ = hn::Sub(tau, err);
    high_ = hn::Add(tau, err);
    // With den safely away from 0, tau is known to within a bound; else nothing is known of it.
    safe_ = hn::Gt(den_, hn::Set(d, bounds_.sum_e));
  }

  /// Lanes that the range does not discard.
  [[nodiscard]] HWY_INLINE M in_range(V tau_min, V tau_max) const {
    return hn::Or(hn::Not(safe_), hn::And(hn::Ge(high_, tau_min), hn::Le(low_, tau_max)));
  }

  /// Lanes that are surely hit within (tau_first, tau_last).
  [[nodiscard]] HWY_INLINE M certain(V tau_first, V tau_last) const {
    const D d;
    const V e = hn::Set(d, bounds_.e);
    const M inside =
        hn::And(hn::And(hn::Gt(u_, e), hn::Gt(v_, e)), hn::Gt(w_, hn::Set(d, bounds_.sum_e)));
    return hn::And(hn::And(safe_, inside),
                   hn::And(hn::Gt(low_, tau_first), hn::Lt(high_, tau_last)));
  }

  [[nodiscard]] HWY_INLINE V low() const { return low_; }
  [[nodiscard]] HWY_INLINE V high() const { return high_; }

 private:
  LeafBounds bounds_;
  V3<V> s_, n_;
  V den_, sign_, u_, v_, w_;  // den, u, v and w times the sign
  V low_, high_;
  M safe_;
};

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
