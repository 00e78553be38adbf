// SPDX-License-Identifier: Apache-2.0
//
// Vertices that lie in one place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pierce/types.h"
#include "support/stop_poll.h"

namespace pierce::mesh {

/// For each vertex, the first one at its position: coordinates are compared as numbers (-0 equals
/// 0). One with a NaN is at no other's position. Takes 16 (float) or 32 bytes a vertex while it
/// works. Throws Error (Stopped).
template <class Real>
std::vector<std::uint32_t> first_at_position(std::span<const Vec3<Real>> vertices,
                                             const scene::StopPoll& stop);

extern template std::vector<std::uint32_t> first_at_position(std::span<const Vec3<float>>,
                                                             const scene::StopPoll&);
extern template std::vector<std::uint32_t> first_at_position(std::span<const Vec3<double>>,
                                                             const scene::StopPoll&);

}  // namespace pierce::mesh
