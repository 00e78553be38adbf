// SPDX-License-Identifier: Apache-2.0
//
// How a difference between an answer and the oracle's is told: in hexadecimal floats, so that not a
// bit is lost, and with the command that shows the case to every textbook method.
#pragma once

#include <span>
#include <string>

#include "pierce/types.h"

namespace pierce::tool {

/// Same bits in every field.
template <class Real>
[[nodiscard]] bool identical(const Hit<Real>& a, const Hit<Real>& b);

/// Which query of which ray differs, what the oracle says, what the scene said.
template <class Real>
[[nodiscard]] std::string describe_difference(const std::string& where,
                                              std::span<const MeshView<Real>> meshes,
                                              const Ray<Real>& ray,
                                              std::span<const Hit<Real>> expected,
                                              std::span<const Hit<Real>> got);

}  // namespace pierce::tool
