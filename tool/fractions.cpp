// SPDX-License-Identifier: Apache-2.0
#include "fractions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/big_int.h"
#include "exact/round_ratio.h"

namespace pierce::tool {
namespace {

using exact::BigInt;
using exact::bit_length;

BigInt power_of_ten(int exponent) {
  return boost::multiprecision::pow(BigInt(10), static_cast<unsigned>(exponent));
}

Fraction times_power_of_ten(const Fraction& x, int exponent) {
  return exponent >= 0 ? Fraction(x * Fraction(power_of_ten(exponent)))
                       : Fraction(x / Fraction(power_of_ten(-exponent)));
}

Fraction power_of_two(int exponent) {
  const Fraction power(BigInt(1) << std::abs(exponent));
  return exponent >= 0 ? power : Fraction(Fraction(1) / power);
}

// The e with 2^e <= |x| < 2^(e+1); x is not 0.
int exponent_of_two(const Fraction& x) {
  const int guess = bit_length(numerator(x)) - bit_length(denominator(x));  // e or e + 1
  return abs(x) < power_of_two(guess) ? guess - 1 : guess;
}

// The e with 10^e <= |x| < 10^(e+1); x is not 0.
int exponent_of_ten(const Fraction& x) {
  int e = static_cast<int>(std::floor(exponent_of_two(x) * std::log10(2.0)));
  while (abs(x) >= times_power_of_ten(1, e + 1)) ++e;
  while (abs(x) < times_power_of_ten(1, e)) --e;
  return e;
}

BigInt round_to_integer(const Fraction& x) {  // x >= 0; ties to even
  BigInt quotient, rest;
  divide_qr(numerator(x), denominator(x), quotient, rest);
  const BigInt twice = 2 * rest;
  if (twice > denominator(x) || (twice == denominator(x) && bit_test(quotient, 0))) ++quotient;
  return quotient;
}

// d.ddd times 10^e, or without an exponent where that is short enough to read.
std::string place_point(std::string digits, int e) {
  const int count = static_cast<int>(digits.size());
  if (e < -5 || e > 20) {
    if (count > 1) digits.insert(1, ".");
    return digits + "e" + std::to_string(e);
  }
  if (e < 0) return "0." + std::string(static_cast<std::size_t>(-e - 1), '0') + digits;
  if (count <= e + 1) return digits + std::string(static_cast<std::size_t>(e + 1 - count), '0');
  return digits.insert(static_cast<std::size_t>(e) + 1, ".");
}

}  // namespace

std::string as_fraction(const Fraction& x) { return x.convert_to<std::string>(); }

std::string as_decimal(const Fraction& x, int digits) {
  if (x == 0) return "0";
  int e = exponent_of_ten(x);
  std::string text = round_to_integer(times_power_of_ten(abs(x), digits - 1 - e)).str();
  if (static_cast<int>(text.size()) > digits) ++e;  // 9.99 became 10.0
  text.erase(text.find_last_not_of('0') + 1);
  return (x < 0 ? "-" : "") + place_point(std::move(text), e);
}

bool is_decimal(const Fraction& x, int digits) {
  return x == 0 || denominator(times_power_of_ten(x, digits - 1 - exponent_of_ten(x))) == 1;
}

template <class Real>
Real nearest(const Fraction& x) {
  return exact::round_ratio<Real>(numerator(x), denominator(x), 0);
}

Reference reference(const Fraction& x) {
  if (x == 0) return {};
  const int exponent = exponent_of_two(x);
  const Fraction scaled = x / power_of_two(exponent);  // 1 to 2 in magnitude
  const double head = nearest<double>(scaled);
  return {head, nearest<double>(scaled - Fraction(head)), exponent};
}

template <class Real>
double error_in_ulp(Real computed, const Reference& exact) {
  using Limits = std::numeric_limits<Real>;
  if (!std::isfinite(computed)) return std::numeric_limits<double>::infinity();
  constexpr int kSmallestNormal = Limits::min_exponent - 1;
  const int exponent = exact.head == 0 ? kSmallestNormal : exact.exponent;
  const int last_place = std::max(exponent, kSmallestNormal) - Limits::digits + 1;
  const long double scaled = std::ldexp(static_cast<long double>(computed), -exponent);
  const long double error =
      scaled - static_cast<long double>(exact.head) - static_cast<long double>(exact.tail);
  return static_cast<double>(std::ldexp(std::abs(error), exponent - last_place));
}

template float nearest(const Fraction&);
template double nearest(const Fraction&);
template double error_in_ulp(float, const Reference&);
template double error_in_ulp(double, const Reference&);
template double error_in_ulp(long double, const Reference&);

}  // namespace pierce::tool
