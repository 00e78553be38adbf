// SPDX-License-Identifier: Apache-2.0
#include "io/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "exact/affine.h"
#include "exact/scaled_integers.h"

namespace pierce::io {

Matrix product(const Matrix& outer, const Matrix& inner) {
  Matrix out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& row = outer.rows[i];
    const std::array<double, 4> turn = {row[0], row[1], row[2], 0};
    for (std::size_t j = 0; j < 4; ++j) {
      out.rows[i][j] = exact::round_affine(j == 3 ? row : turn, inner.rows[0][j], inner.rows[1][j],
                                           inner.rows[2][j]);
    }
  }
  return out;
}

bool is_finite(const Matrix& matrix) {
  for (const auto& row : matrix.rows) {
    for (const double x : row) {
      if (!std::isfinite(x)) return false;
    }
  }
  return true;
}

bool mirrors(const Matrix& matrix) {
  int place = 0;
  for (const auto& row : matrix.rows) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (row[k] != 0) place = std::min(place, exact::binary_parts(row[k]).exponent);
    }
  }
  const auto m = [&](std::size_t i, std::size_t j) {
    return exact::scaled_integer<exact::BigInt>(matrix.rows[i][j % 3], place);
  };
  exact::BigInt determinant = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    determinant += m(0, j) * (m(1, j + 1) * m(2, j + 2) - m(1, j + 2) * m(2, j + 1));
  }
  return determinant < 0;
}

Vec3<double> placed(const Matrix& matrix, const Vec3<double>& p) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return p;
  const auto along = [&](std::size_t i) {
    return exact::round_affine(matrix.rows[i], p.x, p.y, p.z);
  };
  return {along(0), along(1), along(2)};
}

}  // namespace pierce::io
