// SPDX-License-Identifier: Apache-2.0
//
// Numbers m * 2^e with an integer m of any size: what floats are, closed under +, - and *, exact,
// and an order of magnitude quicker than rationals since nothing is ever brought to lowest terms.
// The oracles that must see 10^7 cases compute in these.
#pragma once

#include <gmpxx.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "pierce/types.h"

namespace pierce::oracle {

class Dyadic {
 public:
  Dyadic() = default;
  explicit Dyadic(int value) : m_(value) {}
  Dyadic(mpz_class mantissa, long exponent) : m_(std::move(mantissa)), e_(exponent) {}

  /// The exact value of a finite float or double.
  template <class Real>
  requires std::is_floating_point_v<Real>
  explicit Dyadic(Real value) {
    int exponent = 0;
    const double fraction = std::frexp(static_cast<double>(value), &exponent);
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
    if (mantissa == 0) return;
    // Short mantissas keep the products short: most test data is far from 53 bits long.
    const int zeros = __builtin_ctzll(static_cast<std::uint64_t>(mantissa));
    m_ = static_cast<long>(mantissa / (std::int64_t{1} << zeros));
    e_ = exponent - 53 + zeros;
  }

  [[nodiscard]] int sign() const { return sgn(m_); }
  [[nodiscard]] const mpz_class& mantissa() const { return m_; }
  [[nodiscard]] long exponent() const { return e_; }

  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    Dyadic product;
    mpz_mul(product.m_.get_mpz_t(), a.m_.get_mpz_t(), b.m_.get_mpz_t());
    product.e_ = a.e_ + b.e_;
    return product;
  }
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return combine(a, b, false); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return combine(a, b, true); }
  friend Dyadic operator-(const Dyadic& a) { return Dyadic(-a.m_, a.e_); }

  friend int compare(const Dyadic& a, const Dyadic& b) {
    if (a.sign() != b.sign()) return a.sign() < b.sign() ? -1 : 1;
    return (a - b).sign();
  }

 private:
  // a + b or a - b: the operand with the larger exponent is shifted to the smaller one.
  static Dyadic combine(const Dyadic& a, const Dyadic& b, bool negate_b) {
    if (b.sign() == 0) return a;
    Dyadic sum;
    if (a.sign() == 0) {
      sum = b;
      if (negate_b) mpz_neg(sum.m_.get_mpz_t(), sum.m_.get_mpz_t());
      return sum;
    }
    mpz_ptr s = sum.m_.get_mpz_t();
    const auto accumulate = [&](mpz_srcptr x, mpz_srcptr y) {
      negate_b ? mpz_sub(s, x, y) : mpz_add(s, x, y);
    };
    if (a.e_ == b.e_) {
      accumulate(a.m_.get_mpz_t(), b.m_.get_mpz_t());
      sum.e_ = a.e_;
    } else if (a.e_ > b.e_) {
      mpz_mul_2exp(s, a.m_.get_mpz_t(), static_cast<mp_bitcnt_t>(a.e_ - b.e_));
      accumulate(s, b.m_.get_mpz_t());
      sum.e_ = b.e_;
    } else {
      mpz_mul_2exp(s, b.m_.get_mpz_t(), static_cast<mp_bitcnt_t>(b.e_ - a.e_));
      accumulate(a.m_.get_mpz_t(), s);
      sum.e_ = a.e_;
    }
    return sum;
  }

  mpz_class m_;
  long e_ = 0;
};

struct DyadicVec {
  Dyadic x, y, z;
};

template <class Real>
DyadicVec exact(const Vec3<Real>& v) {
  return {Dyadic(v.x), Dyadic(v.y), Dyadic(v.z)};
}
inline DyadicVec operator+(const DyadicVec& a, const DyadicVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline DyadicVec operator-(const DyadicVec& a, const DyadicVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline DyadicVec operator*(const Dyadic& k, const DyadicVec& a) {
  return {k * a.x, k * a.y, k * a.z};
}
inline Dyadic dot(const DyadicVec& a, const DyadicVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline DyadicVec cross(const DyadicVec& a, const DyadicVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline bool is_zero(const DyadicVec& a) {
  return a.x.sign() == 0 && a.y.sign() == 0 && a.z.sign() == 0;
}

}  // namespace pierce::oracle
