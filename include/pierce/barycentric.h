// SPDX-License-Identifier: Apache-2.0
//
// Barycentric coordinates: a point as a weighted mean of the corners of a simplex.
//
//   p = l_0 c_0 + l_1 c_1 + ... + l_k c_k,     l_0 + l_1 + ... + l_k = 1     (Moebius 1827)
//
// The weight of a corner is the signed size (length, area, volume) of the simplex in which p takes
// that corner's place, over the size of the whole. So it is 1 at its corner, 0 on the whole face
// opposite, and negative beyond that face: the signs say in which region p lies (seven for a
// triangle), and the zeros on which face (see carrier).
//
// Any scalar type; over an exact rational everything is exact, and the tests for zero mean zero.
// A simplex without size has no coordinates: nullopt. Pure functions; no allocation for built-in
// types. docs/textbook.md has the picture.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <utility>

#include "pierce/vector.h"

namespace pierce {

/// A point in the plane.
template <class Scalar>
struct Vec2 {
  Scalar x, y;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

/// Of a point in a 2D triangle: three signed areas over the whole. 8 multiplications, 3 divisions.
template <class Scalar>
std::optional<std::array<Scalar, 3>> barycentric(const Vec2<Scalar>& p, const Vec2<Scalar>& a,
                                                 const Vec2<Scalar>& b, const Vec2<Scalar>& c) {
  const auto twice_area = [](const Vec2<Scalar>& q, const Vec2<Scalar>& r,
                             const Vec2<Scalar>& s) -> Scalar {
    return (r.x - q.x) * (s.y - q.y) - (r.y - q.y) * (s.x - q.x);
  };
  const Scalar whole = twice_area(a, b, c);
  if (whole == 0) return std::nullopt;
  return std::array<Scalar, 3>{twice_area(p, b, c) / whole, twice_area(a, p, c) / whole,
                               twice_area(a, b, p) / whole};
}

/// Of a point in the plane of a 3D triangle: areas again, signed by the normal, as in Shirley,
/// "Fundamentals of Computer Graphics":
///   n = (b-a) x (c-a),  l_a = n.((c-b) x (p-b)) / n.n,  and so on round the triangle.
/// For a point beside the plane they are those of its orthogonal projection.
template <class Scalar>
std::optional<std::array<Scalar, 3>> barycentric(const Vec3<Scalar>& p, const Vec3<Scalar>& a,
                                                 const Vec3<Scalar>& b, const Vec3<Scalar>& c) {
  const Vec3<Scalar> n = cross(b - a, c - a);
  const Scalar n_n = dot(n, n);
  if (n_n == 0) return std::nullopt;
  return std::array<Scalar, 3>{dot(n, cross(c - b, p - b)) / n_n, dot(n, cross(a - c, p - c)) / n_n,
                               dot(n, cross(b - a, p - a)) / n_n};
}

/// Of a point in a tetrahedron: (l_1, l_2, l_3) = T^-1 (p - r4), where the columns of T are
/// r1 - r4, r2 - r4, r3 - r4 (the rows of T^-1 are their cross products over the determinant), and
/// l_4 is what is left of 1.
template <class Scalar>
std::optional<std::array<Scalar, 4>> barycentric(const Vec3<Scalar>& p, const Vec3<Scalar>& r1,
                                                 const Vec3<Scalar>& r2, const Vec3<Scalar>& r3,
                                                 const Vec3<Scalar>& r4) {
  const Vec3<Scalar> t1 = r1 - r4, t2 = r2 - r4, t3 = r3 - r4;
  const Vec3<Scalar> row1 = cross(t2, t3), row2 = cross(t3, t1), row3 = cross(t1, t2);
  const Scalar det = dot(t1, row1);
  if (det == 0) return std::nullopt;
  const Vec3<Scalar> r = p - r4;
  const Scalar l1 = dot(row1, r) / det, l2 = dot(row2, r) / det, l3 = dot(row3, r) / det;
  return std::array<Scalar, 4>{l1, l2, l3, 1 - l1 - l2 - l3};
}

namespace detail {

/// Solves m x = right by elimination with the largest pivots; nullopt if m is singular.
template <class Scalar, std::size_t n>
std::optional<std::array<Scalar, n>> solve(std::array<std::array<Scalar, n>, n> m,
                                           std::array<Scalar, n> right) {
  const auto size = [](const Scalar& x) { return x < 0 ? Scalar(-x) : x; };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < n; ++row) {
      if (size(m[row][k]) > size(m[pivot][k])) pivot = row;
    }
    if (m[pivot][k] == 0) return std::nullopt;
    std::swap(m[k], m[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t row = k + 1; row < n; ++row) {
      const Scalar factor = m[row][k] / m[k][k];
      for (std::size_t column = k + 1; column < n; ++column) {
        m[row][column] -= factor * m[k][column];
      }
      right[row] -= factor * right[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t column = k + 1; column < n; ++column) right[k] -= m[k][column] * right[column];
    right[k] /= m[k][k];
  }
  return right;
}

}  // namespace detail

/// Of a point in a simplex with `corners` corners in `n`-dimensional space: a segment, a triangle,
/// a tetrahedron, ... in any space that can hold it. With E the matrix of columns c_i - c_0, solves
/// E l = p - c_0, or, when the space has dimensions to spare, E^T E l = E^T (p - c_0): for a point
/// beside the simplex's own plane the coordinates of its orthogonal projection.
template <class Scalar, std::size_t corners, std::size_t n>
std::optional<std::array<Scalar, corners>> barycentric(
    const std::array<Scalar, n>& p, const std::array<std::array<Scalar, n>, corners>& simplex) {
  static_assert(corners >= 2 && corners <= n + 1, "a k-simplex needs k >= 1 and k <= n dimensions");
  constexpr std::size_t k = corners - 1;
  std::array<std::array<Scalar, n>, k> edges;
  std::array<Scalar, n> r;
  for (std::size_t x = 0; x < n; ++x) {
    for (std::size_t i = 0; i < k; ++i) edges[i][x] = simplex[i + 1][x] - simplex[0][x];
    r[x] = p[x] - simplex[0][x];
  }

  std::array<std::array<Scalar, k>, k> m;
  std::array<Scalar, k> right;
  if constexpr (k == n) {
    for (std::size_t x = 0; x < n; ++x) {
      for (std::size_t i = 0; i < k; ++i) m[x][i] = edges[i][x];
      right[x] = r[x];
    }
  } else {
    const auto inner = [](const std::array<Scalar, n>& q, const std::array<Scalar, n>& s) {
      Scalar sum = q[0] * s[0];
      for (std::size_t x = 1; x < n; ++x) sum += q[x] * s[x];
      return sum;
    };
    for (std::size_t i = 0; i < k; ++i) {
      for (std::size_t j = 0; j < k; ++j) m[i][j] = inner(edges[i], edges[j]);
      right[i] = inner(edges[i], r);
    }
  }

  const std::optional<std::array<Scalar, k>> solution = detail::solve<Scalar, k>(m, right);
  if (!solution) return std::nullopt;
  std::array<Scalar, corners> result;
  result[0] = 1;
  for (std::size_t i = 0; i < k; ++i) {
    result[i + 1] = (*solution)[i];
    result[0] -= (*solution)[i];
  }
  return result;
}

/// The corners whose coordinate is negative: p lies beyond the face opposite each of them. None:
/// p is in the closed simplex. All patterns but "all" occur: 2^corners - 1 regions.
template <class Scalar, std::size_t corners>
std::bitset<corners> beyond(const std::array<Scalar, corners>& coordinates) {
  std::bitset<corners> result;
  for (std::size_t i = 0; i < corners; ++i) result[i] = coordinates[i] < 0;
  return result;
}

/// Whether the point lies in the closed simplex: faces, edges and corners belong to it.
template <class Scalar, std::size_t corners>
bool inside_closed(const std::array<Scalar, corners>& coordinates) {
  for (const Scalar& l : coordinates) {
    if (!(l >= 0)) return false;
  }
  return true;
}

/// Whether the point lies in the open simplex: neither outside nor on a face.
template <class Scalar, std::size_t corners>
bool inside_open(const std::array<Scalar, corners>& coordinates) {
  for (const Scalar& l : coordinates) {
    if (!(l > 0)) return false;
  }
  return true;
}

/// The smallest face that holds a point of the closed simplex: the corners whose coordinate is not
/// 0. One corner: the point is that vertex; two: it is on that edge; three: on that face; all: in
/// the open simplex. nullopt for a point outside.
template <class Scalar, std::size_t corners>
std::optional<std::bitset<corners>> carrier(const std::array<Scalar, corners>& coordinates) {
  if (!inside_closed(coordinates)) return std::nullopt;
  std::bitset<corners> result;
  for (std::size_t i = 0; i < corners; ++i) result[i] = coordinates[i] > 0;
  return result;
}

/// What a point inherits from the corners: the mean of their values with its coordinates as
/// weights. A value is anything that can be added and multiplied by a scalar: numbers, Vec3, ...
/// Linear: exact for any attribute that varies linearly over the simplex, positions included.
template <class Scalar, std::size_t corners, class Value>
Value interpolate(const std::array<Scalar, corners>& coordinates,
                  const std::array<Value, corners>& values) {
  Value sum = coordinates[0] * values[0];
  for (std::size_t i = 1; i < corners; ++i) sum = sum + coordinates[i] * values[i];
  return sum;
}

/// The same for attributes of any number of components: colours, texture coordinates, ...
template <class Scalar, std::size_t corners, std::size_t n>
std::array<Scalar, n> interpolate(const std::array<Scalar, corners>& coordinates,
                                  const std::array<std::array<Scalar, n>, corners>& values) {
  std::array<Scalar, n> sum;
  for (std::size_t x = 0; x < n; ++x) {
    sum[x] = coordinates[0] * values[0][x];
    for (std::size_t i = 1; i < corners; ++i) sum[x] += coordinates[i] * values[i][x];
  }
  return sum;
}

}  // namespace pierce
