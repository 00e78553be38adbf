// SPDX-License-Identifier: Apache-2.0
#include "check/exact.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace pierce::tool {
namespace {

using Int = Exact::Int;

long bits_of(const Int& positive) { return static_cast<long>(msb(positive)) + 1; }

// Both numbers over the exponent of the smaller one.
struct Aligned {
  Int a, b;
  long e;
};
Aligned align(const Int& a, long a_e, const Int& b, long b_e) {
  const long e = std::min(a_e, b_e);
  return {a << static_cast<unsigned long>(a_e - e), b << static_cast<unsigned long>(b_e - e), e};
}

}  // namespace

Exact::Exact(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("Exact of a value that is not finite");
  if (value == 0) return;
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  exponent -= 53;
  while (mantissa % 2 == 0) {  // short numbers make quick products
    mantissa /= 2;
    ++exponent;
  }
  n_ = mantissa;
  e_ = exponent;
}

Exact operator+(const Exact& a, const Exact& b) {
  if (a.n_.is_zero()) return b;
  if (b.n_.is_zero()) return a;
  if (a.d_ == b.d_) {
    Aligned x = align(a.n_, a.e_, b.n_, b.e_);
    return {x.a + x.b, a.d_, x.e};
  }
  Aligned x = align(a.n_ * b.d_, a.e_, b.n_ * a.d_, b.e_);
  return {x.a + x.b, a.d_ * b.d_, x.e};
}

Exact operator*(const Exact& a, const Exact& b) {
  if (a.n_.is_zero() || b.n_.is_zero()) return {};
  return {a.n_ * b.n_, a.d_ * b.d_, a.e_ + b.e_};
}

Exact operator/(const Exact& a, const Exact& b) {
  if (a.n_.is_zero()) return {};
  Int n = a.n_ * b.d_;
  Int d = a.d_ * b.n_;
  if (d.sign() < 0) {
    n = -n;
    d = -d;
  }
  return {std::move(n), std::move(d), a.e_ - b.e_};
}

int compare(const Exact& a, const Exact& b) {
  if (a.sign() != b.sign()) return a.sign() < b.sign() ? -1 : 1;
  return (a - b).sign();
}

template <class Real>
Real round_to(const Exact& a) {
  using Limits = std::numeric_limits<Real>;
  constexpr long kDigits = Limits::digits;
  constexpr long kLowest = Limits::min_exponent - kDigits;  // denorm_min is 2^kLowest
  if (a.n_.is_zero()) return 0;
  const bool negative = a.n_.sign() < 0;
  const Int n = abs(a.n_);

  // The value lies in (2^(top - 1), 2^(top + 1)); count it in units of 2^unit.
  const long top = bits_of(n) - bits_of(a.d_) + a.e_;
  if (top > Limits::max_exponent + 1) return negative ? -Limits::infinity() : Limits::infinity();
  if (top < kLowest - 2) return 0;
  for (long unit = std::max(top - kDigits, kLowest);; ++unit) {
    const long up = a.e_ - unit;
    const Int dividend = up >= 0 ? Int(n << static_cast<unsigned long>(up)) : n;
    const Int divisor = up >= 0 ? a.d_ : Int(a.d_ << static_cast<unsigned long>(-up));
    Int quotient, rest;
    divide_qr(dividend, divisor, quotient, rest);
    if (!quotient.is_zero() && bits_of(quotient) > kDigits) continue;  // one bit too many

    const int half = Int(rest * 2).compare(divisor);
    auto count = static_cast<std::uint64_t>(quotient);
    if (half > 0 || (half == 0 && count % 2 == 1)) ++count;
    // At most 2^kDigits, so only overflow to infinity can round here, and that is right.
    const Real magnitude = std::ldexp(static_cast<Real>(count), static_cast<int>(unit));
    return negative && magnitude != 0 ? -magnitude : magnitude;
  }
}

template float round_to(const Exact& a);
template double round_to(const Exact& a);

}  // namespace pierce::tool
