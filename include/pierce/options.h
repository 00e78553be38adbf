// SPDX-License-Identifier: Apache-2.0
//
// What a caller may choose about building, about a query and about batches. No option changes an
// answer; range, skip, sides, masks and max_hits change the question.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <stop_token>

#include "pierce/types.h"

namespace pierce {

/// How much work, and memory, to spend on the search tree. Never changes an answer. A scene takes
/// 50 to 60 bytes a triangle beside the caller's mesh (High up to 70), a compact one 11 to 20.
enum class Quality : std::uint8_t {
  Fast,      ///< quickest build
  Balanced,  ///< the default
  High,      ///< slowest build, fastest queries
  Compact,   ///< least memory, half the speed or less: looks triangles up in the caller's mesh
};

/// Called now and then with the finished fraction of the work, 0 to 1, from one thread at a time.
using Progress = std::function<void(double fraction)>;

/// How a scene is built.
struct BuildOptions {
  Quality quality = Quality::Balanced;
  unsigned threads = 0;  ///< 0: as many as the machine has
  Progress progress = {};
  std::stop_token stop = {};  ///< a stopped build throws Error (Stopped)
  /// Either empty or one mask a geometry (copied): a ray sees a geometry iff their masks have a bit
  /// in common. Empty: every geometry has all bits. Masks mean nothing to points (locate, nearest
  /// points, next origins).
  std::span<const std::uint32_t> masks = {};
};

/// Hits of which facing count: Front is where rays enter a closed mesh whose triangles face
/// outward, Back where they leave it.
enum class Sides : std::uint8_t { Both, Front, Back };

/// All bits: a ray that sees every geometry, save those whose mask is 0.
inline constexpr std::uint32_t kAllBits = 0xffffffffu;

/// No limit to a number of hits.
inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// What a query about one ray is asked beyond the ray itself. What a ray does not see is as if it
/// did not exist: a triangle that it skips, a geometry that its mask hides, and, for hits and
/// passages, the other side of a triangle.
struct QueryOptions {
  Range range = Range::Closed;  ///< means nothing to crossings
  TriangleRef skip = {};        ///< not seen; triangle kNone (the default) names none
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;        ///< see BuildOptions::masks
  std::uint64_t max_hits = kUnlimited;  ///< all_hits only: no more than these, the first ones
};

/// How many candidates each rung of the ladder saw. Filled only when asked for; added to, so that
/// one object can sum over several batches.
struct Statistics {
  std::uint64_t rays = 0;
  std::uint64_t nodes = 0;             ///< wide nodes whose boxes were tested
  std::uint64_t leaves = 0;            ///< leaf blocks tested
  std::uint64_t candidates = 0;        ///< ray-triangle pairs that the float cull did not discard
  std::uint64_t certified = 0;         ///< of these, decided by the double rung
  std::uint64_t settled = 0;           ///< of these, decided by exact arithmetic (fixed width)
  std::uint64_t settled_big = 0;       ///< of these, decided by arithmetic of any size
  std::uint64_t orders_certified = 0;  ///< pairs of hits put in order by the double rung
  std::uint64_t orders_settled = 0;    ///< pairs of hits put in order exactly
  std::uint64_t hits = 0;              ///< hits returned
  std::uint64_t rounded_exactly = 0;   ///< hits whose t, u, v or w needed exact rounding
  std::uint64_t rays_placed_exactly = 0;  ///< rays brought to filter space by exact arithmetic

  Statistics& operator+=(const Statistics& other);
};

/// For a batch of rays; what it has in common with QueryOptions means the same.
struct BatchOptions {
  unsigned threads = 0;  ///< 0: as many as the machine has
  Range range = Range::Closed;
  /// Either empty or one entry a ray: a triangle that this ray does not see, as if it did not exist
  /// (so that an origin on it is not therefore on the surface). The default names none.
  std::span<const TriangleRef> skip = {};
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;  ///< of all rays
  /// Either empty or one mask a ray, in place of `mask`.
  std::span<const std::uint32_t> masks = {};
  std::uint64_t max_hits = kUnlimited;  ///< all_hits only: of each ray
  Statistics* statistics = nullptr;     ///< if set, is added to
  Progress progress = {};
  std::stop_token stop =
      {};  ///< a stopped batch throws Error (Stopped); outputs are then unspecified
};

/// Which points are inside a closed surface that passes through itself, or lies in another one.
enum class InsideRule : std::uint8_t {
  Odd,      ///< those from which a ray crosses the surface an odd number of times
  NonZero,  ///< those around which the surface winds: overlapping solids unite
};

/// For one point or a batch of them: what counts as inside, and what to do about open meshes.
struct LocateOptions {
  unsigned threads = 0;  ///< 0: as many as the machine has
  InsideRule rule = InsideRule::Odd;
  /// Do not ask whether the scene is closed: whatever the crossings of the ray from the point along
  /// +z make of it is the answer. For a closed scene that is the same answer.
  bool open_mesh = false;
  Statistics* statistics = nullptr;  ///< if set, is added to; points count as rays
  Progress progress = {};
  std::stop_token stop =
      {};  ///< a stopped batch throws Error (Stopped); outputs are then unspecified
};

}  // namespace pierce
