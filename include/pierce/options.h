// SPDX-License-Identifier: Apache-2.0
//
// What a caller may choose about building, about a query and about batches. No option changes an
// answer; those of QueryOptions, and their likes in BatchOptions, change the question.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "pierce/types.h"

namespace pierce {

/// How much work, and memory, to spend on the search tree. Never changes an answer. A scene takes
/// 50 to 60 bytes a triangle beside the caller's mesh (up to 70 if cut), a compact one 11 to 20.
enum class Quality : std::uint8_t {
  Fast,      ///< quickest build
  Balanced,  ///< the default: triangles are cut if nearly all of their boxes is air
  High,      ///< slowest build, fastest queries
  Compact,   ///< least memory, half the speed or less: looks triangles up in the caller's mesh
};

/// Called now and then with the finished fraction of the work, 0 to 1, from one thread at a time.
using Progress = std::function<void(double fraction)>;

struct Statistics;

/// How a call does its work, whatever it is asked: the same for builds, refits and batches.
struct WorkOptions {
  unsigned threads = 0;  ///< 0: as many as the machine has
  Progress progress = {};
  /// If set, is looked at now and then: when somebody (another thread, a signal handler) has stored
  /// true there, the call ends within 50 ms with Error (Stopped). What it was to fill is then
  /// unspecified; a scene that was being refitted is as it was.
  const std::atomic<bool>* stop = nullptr;
  Statistics* statistics = nullptr;  ///< if set, a batch adds its counts to it; not for builds
};

/// How a scene is built.
struct BuildOptions {
  Quality quality = Quality::Balanced;
  /// Either empty or one mask a geometry (copied): a ray sees a geometry iff their masks have a bit
  /// in common. Empty: every geometry has all bits. Masks are ignored by points (locate, nearest
  /// points, next origins).
  std::span<const std::uint32_t> masks = {};
  WorkOptions work = {};
  /// Of instances: up to so many bytes, every instance of a mesh beyond the first gets vertices and
  /// a tree of its own, as if it were another mesh; beyond, instances of the same mesh (its arrays
  /// lie in the same place) share one tree. Answers are the same; rays are slower by what it takes
  /// to transform them, and much memory is saved. (About 62 bytes a triangle, 68 in double.) 0:
  /// always share.
  std::uint64_t flatten_limit = std::uint64_t{1} << 29;
};

/// Hits of which facing count: Front is where rays enter a closed mesh whose triangles face
/// outward, Back where they leave it.
enum class Sides : std::uint8_t { Both, Front, Back };

/// All bits: a ray that sees every geometry, save those whose mask is 0.
inline constexpr std::uint32_t kAllBits = 0xffffffffu;

/// No limit to a number of hits.
inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// What becomes of a ray that is not valid (see Ray).
enum class InvalidRays : std::uint8_t {
  Throw,  ///< Error (InvalidRay)
  Miss,   ///< it hits nothing and crosses nothing
};

/// Asked whether a hit counts: transparency, materials, what a particle has met before. `ray` is
/// the ray's number in its batch (0 if it is alone); the numbers of the hit are those that would be
/// returned (a float scene's, as doubles). Of one ray it is asked about each hit once, in the exact
/// order of hits, and no further than it takes to answer. In a batch it is called from several
/// threads at a time. What it throws ends the call and reaches the caller.
using HitFilter = std::function<bool(std::uint64_t ray, const Hit<double>& hit)>;

/// What a query about one ray is asked beyond the ray itself. What a ray does not see is as if it
/// did not exist: a triangle that it skips, a geometry that its mask hides, and, for hits and
/// passages, the other side of a triangle.
struct QueryOptions {
  Range range = Range::Closed;  ///< ignored by crossings: no passage is exactly at an end
  TriangleRef skip = {};        ///< not seen; triangle kNone (the default) names none
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;        ///< see BuildOptions::masks
  std::uint64_t max_hits = kUnlimited;  ///< all_hits only: no more than these, the first ones
  /// If set, only hits that come after this triangle's in the exact order (t, geometry, triangle)
  /// count: the way to step from hit to hit and lose none at equal t. A Hit can be given for it.
  /// The ray's line must hit the triangle, in its range or not, else Error (InvalidArgument).
  TriangleRef after = {};
  /// Of hits at the same exact t only the first in order counts; so does none at the t of `after`.
  bool distinct = false;
  InvalidRays invalid = InvalidRays::Throw;
  /// If set, only hits that it accepts (with true) count. With `distinct`, the first accepted one
  /// at each t.
  HitFilter filter = {};
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

  [[gnu::visibility("default")]] Statistics& operator+=(const Statistics& other);
};

/// For a batch of rays; what it has in common with QueryOptions means the same.
struct BatchOptions {
  Range range = Range::Closed;
  /// Either empty or one entry a ray: a triangle that this ray does not see, as if it did not exist
  /// (so that an origin on it is not therefore on the surface). The default names none.
  std::span<const TriangleRef> skip = {};
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;  ///< of all rays
  /// Either empty or one mask a ray, in place of `mask`.
  std::span<const std::uint32_t> masks = {};
  std::uint64_t max_hits = kUnlimited;  ///< all_hits only: of each ray
  /// Either empty or one entry a ray; the default names none.
  std::span<const TriangleRef> after = {};
  bool distinct = false;
  InvalidRays invalid = InvalidRays::Throw;
  HitFilter filter = {};
  WorkOptions work = {};
};

/// Which points are inside a surface: one that passes through itself, lies in another one, or (the
/// last rule) has holes.
enum class InsideRule : std::uint8_t {
  Odd,      ///< those from which a ray crosses the surface an odd number of times
  NonZero,  ///< those around which the surface winds: overlapping solids unite
  /// As Odd, but of triangles with the same three corner positions, whichever way they face, only
  /// the first counts: for files that have every face twice, back to back, which else cancel.
  Unique,
  Winding,  ///< those whose winding number is above 1/2, see WindingNumber; no edge is too open
};

/// For one point or a batch of them: what counts as inside, and what to do about open meshes.
struct LocateOptions {
  InsideRule rule = InsideRule::Odd;
  /// Do not ask whether the scene is closed: whatever the crossings of the ray from the point along
  /// +z make of it is the answer. For a closed scene that is the same answer. Means nothing to
  /// InsideRule::Winding, which asks nothing of the surface anyway.
  bool open_mesh = false;
  WorkOptions work = {};  ///< points count as rays in its statistics
};

}  // namespace pierce
