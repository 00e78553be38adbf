// SPDX-License-Identifier: Apache-2.0
//
// Vector algebra on Vec3 for any scalar type: float, double, long double or an exact rational.
//
// No `auto` for a value in here or in what is built on it: the operators of many exact types return
// expressions that refer to their operands, and naming the type is what evaluates them.
#pragma once

#include <type_traits>

#include "pierce/types.h"

namespace pierce {

template <class Scalar>
Vec3<Scalar> operator+(const Vec3<Scalar>& p, const Vec3<Scalar>& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}

template <class Scalar>
Vec3<Scalar> operator-(const Vec3<Scalar>& p, const Vec3<Scalar>& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

template <class Scalar>
Vec3<Scalar> operator-(const Vec3<Scalar>& p) {
  return {-p.x, -p.y, -p.z};
}

template <class Scalar>
Vec3<Scalar> operator*(const std::type_identity_t<Scalar>& k, const Vec3<Scalar>& p) {
  return {k * p.x, k * p.y, k * p.z};
}

/// p . q: 3 multiplications.
template <class Scalar>
Scalar dot(const Vec3<Scalar>& p, const Vec3<Scalar>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}

/// p x q: 6 multiplications.
template <class Scalar>
Vec3<Scalar> cross(const Vec3<Scalar>& p, const Vec3<Scalar>& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

/// The component along axis 0, 1 or 2.
template <class Scalar>
const Scalar& component(const Vec3<Scalar>& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// The axis along which p is longest; of equal ones, the first.
template <class Scalar>
int longest_axis(const Vec3<Scalar>& p) {
  const Vec3<Scalar> size = {p.x < 0 ? Scalar(-p.x) : p.x, p.y < 0 ? Scalar(-p.y) : p.y,
                             p.z < 0 ? Scalar(-p.z) : p.z};
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

/// Every number of p as another scalar type; exact when To can hold what From does.
template <class To, class From>
Vec3<To> convert(const Vec3<From>& p) {
  return {static_cast<To>(p.x), static_cast<To>(p.y), static_cast<To>(p.z)};
}

}  // namespace pierce
