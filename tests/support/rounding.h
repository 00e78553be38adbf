// SPDX-License-Identifier: Apache-2.0
//
// The correctly rounded float or double of an exact ratio, by integer arithmetic alone: nearest,
// ties to even, subnormal results, overflow to infinity as IEEE 754 has it; zero, and whatever
// rounds to zero, is +0.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "support/dyadic.h"

namespace pierce::oracle {

/// numerator / denominator * 2^shift, rounded once. The denominator is not zero.
template <class Real>
Real round_ratio(const mpz_class& numerator, const mpz_class& denominator, long shift) {
  using Limits = std::numeric_limits<Real>;
  constexpr long kDigits = Limits::digits;                          // 24 or 53
  constexpr long kLowest = Limits::min_exponent - Limits::digits;   // exponent of denorm_min
  constexpr long kHighest = Limits::max_exponent - Limits::digits;  // exponent of an ulp of max
  if (sgn(numerator) == 0) return 0;
  const bool negative = (sgn(numerator) < 0) != (sgn(denominator) < 0);
  mpz_class n = abs(numerator), d = abs(denominator);

  // |value| lies in (2^(top-1), 2^(top+1)). Choose the unit 2^e so that the quotient has kDigits
  // or kDigits + 1 bits, or, for a subnormal result, so that the unit is denorm_min.
  const long top = static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2)) -
                   static_cast<long>(mpz_sizeinbase(d.get_mpz_t(), 2)) + shift;
  const auto divide = [&](long unit, mpz_class& quotient, mpz_class& rest, mpz_class& divisor) {
    const long up = shift - unit;
    mpz_class dividend = n;
    divisor = d;
    if (up >= 0) {
      dividend <<= static_cast<mp_bitcnt_t>(up);
    } else {
      divisor <<= static_cast<mp_bitcnt_t>(-up);
    }
    mpz_fdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), dividend.get_mpz_t(), divisor.get_mpz_t());
  };
  long e = std::max(top - kDigits, kLowest);
  if (e > kHighest + 1) return negative ? -Limits::infinity() : Limits::infinity();
  if (e < kLowest + 1 && top < kLowest - 2) return 0;  // less than a quarter of denorm_min
  mpz_class quotient, rest, divisor;
  divide(e, quotient, rest, divisor);
  if (static_cast<long>(mpz_sizeinbase(quotient.get_mpz_t(), 2)) > kDigits) {
    ++e;  // one bit too many: the coarser unit gives exactly kDigits
    divide(e, quotient, rest, divisor);
  }

  const int against_half = cmp(mpz_class(2 * rest), divisor);
  if (against_half > 0 || (against_half == 0 && mpz_odd_p(quotient.get_mpz_t()) != 0)) ++quotient;
  // The quotient is at most 2^kDigits: a Real without rounding. ldexp then is exact or overflows.
  const Real magnitude = std::ldexp(static_cast<Real>(quotient.get_ui()), static_cast<int>(e));
  if (magnitude == 0) return 0;
  return negative ? -magnitude : magnitude;
}

template <class Real>
Real round_ratio(const Dyadic& numerator, const Dyadic& denominator) {
  return round_ratio<Real>(numerator.mantissa(), denominator.mantissa(),
                           numerator.exponent() - denominator.exponent());
}

/// Whether numerator / denominator lies exactly half way between two neighbouring finite Reals: the
/// hardest thing to round.
template <class Real>
bool is_tie(const Dyadic& numerator, const Dyadic& denominator) {
  const Real below = round_ratio<Real>(numerator, denominator);
  const Dyadic rest = numerator - Dyadic(std::isinf(below) ? Real(0) : below) * denominator;
  if (std::isinf(below) || rest.sign() == 0) return false;
  const Real towards = std::copysign(std::numeric_limits<Real>::infinity(),
                                     static_cast<Real>(rest.sign() * denominator.sign()));
  const Real above = std::nextafter(below, towards);
  if (std::isinf(above)) return false;
  return compare(Dyadic(2) * numerator, (Dyadic(below) + Dyadic(above)) * denominator) == 0;
}

template <class Real>
Real round_rational(const mpq_class& value) {
  return round_ratio<Real>(value.get_num(), value.get_den(), 0);
}

template <class Real>
Real round_dyadic(const Dyadic& value) {
  return round_ratio<Real>(value.mantissa(), mpz_class(1), value.exponent());
}

}  // namespace pierce::oracle
