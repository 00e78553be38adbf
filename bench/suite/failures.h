// SPDX-License-Identifier: Apache-2.0
//
// The other side of speed: who lets rays out of closed meshes? From points inside, rays are aimed
// at every vertex and every edge midpoint. Each of them hits, and passes the surface an odd number
// of times, whatever rounding did to its direction.
#pragma once

#include <string>

namespace pierce::bench {

/// A table for the README: meshes, contenders, misses, wrong parities. Takes some seconds.
[[nodiscard]] std::string failures_text();

}  // namespace pierce::bench
