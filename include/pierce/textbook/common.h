// SPDX-License-Identifier: Apache-2.0
//
// What all textbook methods share: the hit they return, the range test, and a Ray whose range can
// be unbounded over numbers that know no infinity.
//
// An exact rational has no infinity (its numeric_limits say 0), so Ray<Rational> is a
// specialisation whose two ends are of type Bound: a number, or minus or plus infinity. Its
// default range is [0, infinity), like that of any other Ray, and `t_min <= t && t <= t_max` is
// written and read the same for every scalar type.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include "pierce/types.h"
#include "pierce/vector.h"

namespace pierce {

/// Where a ray pierces a triangle, as a textbook method computed it:
/// `origin + t direction = (1 - u - v) a + u b + v c`.
template <class Scalar>
struct TextbookHit {
  Scalar t, u, v;
  friend bool operator==(const TextbookHit&, const TextbookHit&) = default;
};

/// An end of a range of exact numbers: a number, or an infinity of either sign.
template <class Exact>
class Bound {
 public:
  Bound(Exact value) : value_(std::move(value)) {}
  [[nodiscard]] static Bound infinity() { return Bound(+1); }
  [[nodiscard]] static Bound minus_infinity() { return Bound(-1); }

  friend bool operator<=(const Exact& t, const Bound& end) {
    return end.infinite_ > 0 || (end.infinite_ == 0 && t <= end.value_);
  }
  friend bool operator<=(const Bound& end, const Exact& t) {
    return end.infinite_ < 0 || (end.infinite_ == 0 && end.value_ <= t);
  }

 private:
  explicit Bound(int infinite) : value_(0), infinite_(infinite) {}
  Exact value_;
  int infinite_ = 0;  // the sign of the infinity; 0: the end is value_
};

/// A ray over numbers without infinity; everything else is as for other rays.
template <class Exact>
requires(!std::numeric_limits<Exact>::has_infinity) struct Ray<Exact> {
  Vec3<Exact> origin, direction;
  Bound<Exact> t_min = Exact(0);
  Bound<Exact> t_max = Bound<Exact>::infinity();
};

/// Whether t lies in the closed range of the ray. A NaN does not.
template <class Scalar>
bool in_range(const Ray<Scalar>& ray, const Scalar& t) {
  return ray.t_min <= t && t <= ray.t_max;
}

/// The same ray over another scalar type; infinite ends stay infinite.
template <class To, class From>
Ray<To> convert(const Ray<From>& ray) {
  Ray<To> result = {convert<To>(ray.origin), convert<To>(ray.direction)};
  if constexpr (std::numeric_limits<To>::has_infinity) {
    result.t_min = static_cast<To>(ray.t_min);
    result.t_max = static_cast<To>(ray.t_max);
  } else {
    const auto end = [](From t) {
      if (!std::isinf(t)) return Bound<To>(To(t));
      return t > 0 ? Bound<To>::infinity() : Bound<To>::minus_infinity();
    };
    result.t_min = end(ray.t_min);
    result.t_max = end(ray.t_max);
  }
  return result;
}

}  // namespace pierce
