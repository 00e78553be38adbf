// SPDX-License-Identifier: Apache-2.0
//
// Exact: a rational number n / d * 2^e of any size, as a scalar for the textbook methods. It is
// never brought to lowest terms (that is what makes rationals slow), which is fine for the handful
// of operations between an input and an answer.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <compare>
#include <utility>

namespace pierce::tool {

class Exact;
template <class Real>
Real round_to(const Exact& a);

class Exact {
 public:
  using Int = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>,
                                            boost::multiprecision::et_off>;

  Exact() = default;
  Exact(int value) : n_(value) {}

  /// The number that a finite float or double stands for. Throws std::invalid_argument for others.
  explicit Exact(double value);

  [[nodiscard]] int sign() const { return n_.sign(); }

  friend Exact operator-(Exact a) {
    a.n_ = -a.n_;
    return a;
  }
  friend Exact operator+(const Exact& a, const Exact& b);
  friend Exact operator-(const Exact& a, const Exact& b) { return a + (-b); }
  friend Exact operator*(const Exact& a, const Exact& b);
  friend Exact operator/(const Exact& a, const Exact& b);  ///< b is not zero
  Exact& operator+=(const Exact& b) { return *this = *this + b; }

  /// The nearest Real, ties to even; infinite from half an ulp beyond the largest; zero is +0.
  template <class Real>
  friend Real round_to(const Exact& a);

  friend int compare(const Exact& a, const Exact& b);
  friend bool operator==(const Exact& a, const Exact& b) { return compare(a, b) == 0; }
  friend std::strong_ordering operator<=>(const Exact& a, const Exact& b) {
    return compare(a, b) <=> 0;
  }

 private:
  Exact(Int n, Int d, long e) : n_(std::move(n)), d_(std::move(d)), e_(e) {}

  Int n_ = 0, d_ = 1;  // d_ > 0
  long e_ = 0;
};

extern template float round_to(const Exact& a);
extern template double round_to(const Exact& a);

}  // namespace pierce::tool
