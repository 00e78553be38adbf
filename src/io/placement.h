// SPDX-License-Identifier: Apache-2.0
//
// Affine maps of files whose meshes stand in several places. Everything is rounded once, as
// Instance has it.
#pragma once

#include "pierce/transform.h"
#include "pierce/types.h"

namespace pierce::io {

using Matrix = Transform<double>;

/// First `inner`, then `outer`; each entry rounded once. Both are finite.
[[nodiscard]] Matrix product(const Matrix& outer, const Matrix& inner);

[[nodiscard]] bool is_finite(const Matrix& matrix);

/// Whether it turns the inside out, decided exactly.
[[nodiscard]] bool mirrors(const Matrix& matrix);

/// The exact image rounded once. A point that is not finite stays as it is, for whoever builds a
/// scene to name.
[[nodiscard]] Vec3<double> placed(const Matrix& matrix, const Vec3<double>& p);

}  // namespace pierce::io
