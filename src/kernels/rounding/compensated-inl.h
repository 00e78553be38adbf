// SPDX-License-Identifier: Apache-2.0
//
// Compensated arithmetic in lanes: a number as double arithmetic has it, and beside it what was
// rounded off on the way, itself in double. Nothing is normalized in between, so the high parts
// follow each other a step an operation and the low parts come behind: some twenty steps for a
// determinant where double-doubles (exact/double_double.h) take fifty, with about as many correct
// bits. proofs/compensated.g counts what is lost. Sources: Ogita, Rump, Oishi 2005; Dekker 1971.
#if defined(PIERCE_KERNELS_COMPENSATED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_COMPENSATED_INL_H_
#undef PIERCE_KERNELS_COMPENSATED_INL_H_
#else
#define PIERCE_KERNELS_COMPENSATED_INL_H_
#endif

#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// high + low; where numbers have cancelled, low may be the larger.
template <class V>
struct Compensated {
  V high, low;
};

template <class V>
HWY_INLINE Compensated<V> two_sum(V a, V b) {
  const V sum = hn::Add(a, b);
  const V b_part = hn::Sub(sum, a);
  const V a_part = hn::Sub(sum, b_part);
  return {sum, hn::Add(hn::Sub(a, a_part), hn::Sub(b, b_part))};
}

template <class V>
HWY_INLINE Compensated<V> two_product(V a, V b) {
  const V product = hn::Mul(a, b);
#if HWY_NATIVE_FMA
  return {product, hn::MulSub(a, b, product)};
#else
  const V splitter = hn::Set(hn::DFromV<V>(), 0x1p27 + 1);
  const V a_big = hn::Mul(splitter, a);
  const V a_high = hn::Sub(a_big, hn::Sub(a_big, a));
  const V a_low = hn::Sub(a, a_high);
  const V b_big = hn::Mul(splitter, b);
  const V b_high = hn::Sub(b_big, hn::Sub(b_big, b));
  const V b_low = hn::Sub(b, b_high);
  const V corners = hn::Add(hn::Mul(a_high, b_low), hn::Mul(a_low, b_high));
  const V rest = hn::Sub(hn::Mul(a_high, b_high), product);
  return {product, hn::Add(hn::Add(rest, corners), hn::Mul(a_low, b_low))};
#endif
}

// The same number, |low| at most half an ulp of high.
template <class V>
HWY_INLINE Compensated<V> normalized(const Compensated<V>& x) {
  return two_sum(x.high, x.low);
}

template <class V>
HWY_INLINE Compensated<V> sum(const Compensated<V>& a, const Compensated<V>& b) {
  const Compensated<V> s = two_sum(a.high, b.high);
  return {s.high, hn::Add(s.low, hn::Add(a.low, b.low))};
}

template <class V>
HWY_INLINE Compensated<V> product(const Compensated<V>& a, const Compensated<V>& b) {
  const Compensated<V> p = two_product(a.high, b.high);
  return {p.high, hn::Add(p.low, hn::MulAdd(a.high, b.low, hn::Mul(a.low, b.high)))};
}

template <class V>
HWY_INLINE Compensated<V> product(const Compensated<V>& a, V b) {
  const Compensated<V> p = two_product(a.high, b);
  return {p.high, hn::MulAdd(a.low, b, p.low)};
}

// The rest is alike for numbers of two parts that have a sum and a product (tracked-inl.h).
template <class N>
concept TwoParts = requires(N x) {
  x.high;
  x.low;
};

// The numbers in double, or closer to the true ones.
template <TwoParts N>
HWY_INLINE auto highs(const V3<N>& p) {
  return V3<decltype(N::high)>{p.x.high, p.y.high, p.z.high};
}

template <TwoParts N>
HWY_INLINE N negated(N a) {
  return {hn::Neg(a.high), hn::Neg(a.low)};
}
template <TwoParts N>
HWY_INLINE N difference(N a, N b) {
  return sum(a, negated(b));
}
template <class V, TwoParts N>
HWY_INLINE N product(V a, N b) {
  return product(b, a);
}
template <TwoParts N>
HWY_INLINE N product_plus(N a, N b, N c) {
  return sum(product(a, b), c);
}
template <class V, TwoParts N>
HWY_INLINE N product_plus(N a, V b, N c) {
  return sum(product(a, b), c);
}
template <TwoParts N>
HWY_INLINE N product_minus(N a, N b, N c) {
  return difference(product(a, b), c);
}
template <class V, TwoParts N>
HWY_INLINE N product_minus(V a, N b, N c) {
  return difference(product(b, a), c);
}

// Of normalized numbers; `inverse` is 1 / b.high. What the first quotient leaves of the numerator
// is small, so that double is enough for it.
template <class V>
HWY_INLINE Compensated<V> quotient(const Compensated<V>& a, const Compensated<V>& b, V inverse) {
  const V first = hn::Mul(a.high, inverse);
#if HWY_NATIVE_FMA
  const V rest = hn::NegMulAdd(b.high, first, a.high);
#else
  const Compensated<V> p = two_product(b.high, first);
  const V rest = hn::Sub(hn::Sub(a.high, p.high), p.low);
#endif
  const V all = hn::Add(rest, hn::NegMulAdd(b.low, first, a.low));
  return {first, hn::Mul(all, inverse)};
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
