// SPDX-License-Identifier: Apache-2.0
//
// The campaign's numbers: input doubles as GMP integers over a common power of two, and exact
// values rounded once. Written from docs/guarantees.md alone, so that no mistake of the library or
// of its other oracles can be shared. Everything here is over double: every float is one.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "pierce/types.h"

namespace pierce::campaign {

using Int = mpz_class;
using Ratio = mpq_class;
using Point = Vec3<double>;

struct IntVec {
  Int x, y, z;
};

inline IntVec operator-(const IntVec& p, const IntVec& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}
inline Int dot(const IntVec& p, const IntVec& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
inline IntVec cross(const IntVec& p, const IntVec& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
inline bool is_zero(const IntVec& p) { return p.x == 0 && p.y == 0 && p.z == 0; }

/// The first component that is not 0 gives the sign: that of p . (e, e^2, e^3) for e -> 0.
inline int infinitesimal_sign(const IntVec& p) {
  return p.x != 0 ? sgn(p.x) : p.y != 0 ? sgn(p.y) : sgn(p.z);
}

/// x = mantissa * 2^exponent, the mantissa odd or 0.
struct Parts {
  std::int64_t mantissa = 0;
  int exponent = std::numeric_limits<int>::max();
  explicit Parts(double x) {
    if (x == 0) return;
    int e = 0;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &e), 53));
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    mantissa >>= zeros;  // exact: the bits shifted out are 0
    exponent = e - 53 + zeros;
  }
};

/// Turns numbers into integers: all those that it has seen, times the same power of two.
class Scale {
 public:
  Scale& see(const Point& p) {
    for (const double x : {p.x, p.y, p.z}) unit_ = std::min(unit_, Parts(x).exponent);
    return *this;
  }
  [[nodiscard]] Int integer(double x) const {
    const Parts parts(x);
    if (parts.mantissa == 0) return 0;
    Int value(static_cast<long>(parts.mantissa));
    value <<= static_cast<unsigned long>(parts.exponent - unit_);
    return value;
  }
  [[nodiscard]] IntVec integers(const Point& p) const {
    return {integer(p.x), integer(p.y), integer(p.z)};
  }
  /// What an integer must be multiplied by, to the given power, to be the number again.
  [[nodiscard]] Ratio restore(const Ratio& value, int power) const {
    if (unit_ == std::numeric_limits<int>::max()) return value;
    Ratio result;
    const int shift = unit_ * power;
    if (shift >= 0) {
      mpq_mul_2exp(result.get_mpq_t(), value.get_mpq_t(), static_cast<unsigned long>(shift));
    } else {
      mpq_div_2exp(result.get_mpq_t(), value.get_mpq_t(), static_cast<unsigned long>(-shift));
    }
    return result;
  }

 private:
  int unit_ = std::numeric_limits<int>::max();
};

inline Ratio ratio(const Int& numerator, const Int& denominator) {
  Ratio q(numerator, denominator);
  q.canonicalize();
  return q;
}

inline long bits(const Int& value) {
  return static_cast<long>(mpz_sizeinbase(value.get_mpz_t(), 2));
}

inline Int shifted(const Int& value, long places) {
  Int result;
  if (places >= 0) mpz_mul_2exp(result.get_mpz_t(), value.get_mpz_t(), places);
  if (places < 0) mpz_fdiv_q_2exp(result.get_mpz_t(), value.get_mpz_t(), -places);
  return result;
}

/// The exponent of the last place of a number of Real that lies in [2^e, 2^(e+1)).
template <class Real>
long last_place(long e) {
  using Limits = std::numeric_limits<Real>;
  return std::max<long>(e - Limits::digits + 1, Limits::min_exponent - Limits::digits);
}

/// count * 2^place, where count <= 2^digits: exact, or infinite.
template <class Real>
Real assembled(const Int& count, long place, bool negative) {
  const Real size = std::ldexp(static_cast<Real>(count.get_d()), static_cast<int>(place));
  return negative && size != 0 ? -size : size;
}

/// The nearest Real, ties to even, zero is +0.
template <class Real>
Real rounded(const Ratio& value) {
  if (value == 0) return 0;
  Int top = abs(value.get_num());
  Int bottom = value.get_den();
  long e = bits(top) - bits(bottom);
  if (shifted(top, std::max(0L, -e)) < shifted(bottom, std::max(0L, e))) --e;
  const long place = last_place<Real>(e);
  (place >= 0 ? bottom : top) <<= static_cast<unsigned long>(std::abs(place));
  Int count, rest;
  mpz_fdiv_qr(count.get_mpz_t(), rest.get_mpz_t(), top.get_mpz_t(), bottom.get_mpz_t());
  const int half = cmp(Int(2 * rest), bottom);
  if (half > 0 || (half == 0 && mpz_odd_p(count.get_mpz_t()))) ++count;
  return assembled<Real>(count, place, value < 0);
}

/// The Real nearest to the square root of a value that is not negative.
template <class Real>
Real rounded_root(const Ratio& square) {
  if (square == 0) return 0;
  Int top = square.get_num(), bottom = square.get_den();
  long e = (bits(top) - bits(bottom)) / 2 - 2;
  const auto reaches = [&](long exponent) {  // square >= 4^exponent
    return shifted(top, std::max(0L, -2 * exponent)) >= shifted(bottom, std::max(0L, 2 * exponent));
  };
  while (reaches(e + 1)) ++e;
  const long place = last_place<Real>(e);
  (place >= 0 ? bottom : top) <<= static_cast<unsigned long>(std::abs(2 * place));
  Int count = sqrt(Int(top / bottom));
  const Int twice = 2 * count + 1;
  const int half = cmp(Int(4 * top), Int(twice * twice * bottom));
  if (half > 0 || (half == 0 && mpz_odd_p(count.get_mpz_t()))) ++count;
  return assembled<Real>(count, place, false);
}

}  // namespace pierce::campaign
