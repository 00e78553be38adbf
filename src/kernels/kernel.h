// SPDX-License-Identifier: Apache-2.0
//
// What a kernel is: the wide part of a query, in float, in filter space. A kernel traverses the
// tree and discards what cannot be hit; candidates that float cannot decide go to a callback, the
// exact Resolver, which is never wrong. So no kernel can make an answer wrong, save by discarding
// too much or by being certain too soon; the bounds that rule this out are in bounds.h.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "bvh/tree.h"
#include "kernels/candidate.h"
#include "kernels/points/axis.h"
#include "kernels/points/nearest.h"
#include "kernels/points/winding.h"
#include "pierce/options.h"
#include "predicate/certify.h"
#include "predicate/types.h"
#include "space/filter_ray.h"

namespace pierce::kernels {

using space::BlurredRay;
using space::FilterRay;

/// Where on the ray a hit lies: low <= tau <= high.
struct TauInterval {
  float low, high;
};

/// A range of t; NaN where it is not known.
struct TRange {
  double min = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
  bool open = false;  // t = min does not count
};

/// The exact resolver: the callback that decides what float cannot. `ray` is the index of the ray
/// in its block, 0 for a single one.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// Whether the ray hits the triangle; fills `tau` if so.
  virtual bool is_hit(std::uint32_t ray, const Candidate& candidate, TauInterval& tau) = 0;
  /// Of two hits, whether the challenger comes before the best one so far: smaller t, or of equal t
  /// the smaller number.
  virtual bool is_before(std::uint32_t ray, const Candidate& challenger, const Candidate& best) = 0;
  /// Which weights of a hit are known to be 0 (predicate::kZeroU ...); may leave out some.
  virtual std::uint8_t zeros(std::uint32_t /*ray*/, const Candidate& hit) { return hit.zeros; }
  /// Whether a triangle surely has the corner, or the edge, in which a hit lies: those corners
  /// whose weights are not known to be 0.
  virtual bool shares_feature(const Candidate& /*candidate*/, const Candidate& /*hit*/) {
    return false;
  }
  /// Of a masked ray: whether it sees the triangle's geometry.
  virtual bool sees(std::uint32_t /*ray*/, std::uint32_t /*primitive*/) { return true; }
  /// The mask of the triangle's geometry.
  virtual std::uint32_t mask_of(std::uint32_t /*primitive*/) { return kAllBits; }
  /// The axes, as bits 1, 2, 4, along which the ray does not move: in float a direction may be 0
  /// that is not. May leave out some.
  virtual std::uint32_t still_axes(std::uint32_t /*ray*/) { return 0; }
  /// Of these, those along which its origin is exactly where `origin` is, in filter space.
  virtual std::uint32_t still_in_place(std::uint32_t /*ray*/, const float* /*origin*/) { return 0; }
  /// The ray's range, if that is known.
  virtual TRange t_range(std::uint32_t /*ray*/) { return {}; }
  /// Whether origin and direction of an exact ray are all of the ray's own: small components may
  /// have been lost into the subnormals.
  virtual bool is_whole(std::uint32_t /*ray*/, const FilterRay& /*of*/) { return false; }
};

/// Callback of a traversal for all hits.
class CandidateSink {
 public:
  virtual ~CandidateSink() = default;
  /// The ray may hit this triangle; if `certain` it does, within its range and off its edges,
  /// unless it does not see it. Called once for each candidate; one in two leaves comes twice.
  virtual void add(const Candidate& candidate, bool certain) = 0;
  /// As Resolver has it. What stands across these axes need not be told.
  virtual std::uint32_t still_axes() { return 0; }
  virtual TRange t_range() { return {}; }
  virtual bool is_whole(const FilterRay& /*of*/) { return false; }
};

/// The magnitudes of the components of an origin are at most `origin`, those of a direction at most
/// `greatest`, and one of them is at least `least`.
struct RayLimits {
  float origin, least, greatest;
};

/// Within which scaling by powers of two is exact, and tau is t times a normal number.
[[nodiscard]] inline RayLimits scaled_limits(float scale) {
  return {space::kKeptOrigin / scale, std::max(0x1p-119F, 0x1p-126F / scale),
          std::min(0x1.fffffep119F, 0x1.fffffep127F / scale)};
}

/// How many rays a kernel takes at once at most.
inline constexpr std::uint32_t kBlockSize = 256;

/// What a kernel writes by itself of a block's hits. The numbers are certain; the names are as if
/// all triangles were of one geometry.
struct FinishedHits {
  Hit<float>* hits = nullptr;                ///< one a ray of the block
  std::uint64_t rays[kBlockSize / 64] = {};  ///< bit i % 64 of word i / 64: hit i is written
  /// The resolver notes there, likewise, which rays it was asked about: their hits are its own.
  std::uint64_t asked[kBlockSize / 64] = {};
  std::uint32_t found = 0;  ///< how many of these are no misses
};

/// How the blocks of a batch have fared so far, and so whether the next one's rays are tried as
/// packets at all. All threads share it, and need not agree: it never changes an answer.
class PacketSchedule {
 public:
  [[nodiscard]] bool rests() const { return rest_.load(std::memory_order_relaxed) != 0; }
  /// Whether the next block is tried.
  bool next() {
    const std::uint32_t rest = rest_.load(std::memory_order_relaxed);
    if (rest != 0) rest_.store(rest - 1, std::memory_order_relaxed);
    return rest == 0;
  }
  /// Of a block that was tried. Each time that packets did not pay twice as many blocks are not.
  void tell(bool paid) {
    const std::uint32_t pause =
        paid ? 0 : std::min(2 * pause_.load(std::memory_order_relaxed) + 1, kLongestPause);
    pause_.store(pause, std::memory_order_relaxed);
    rest_.store(pause, std::memory_order_relaxed);
  }

 private:
  static constexpr std::uint32_t kLongestPause = 31;
  std::atomic<std::uint32_t> rest_ = 0;   // so many blocks are not tried
  std::atomic<std::uint32_t> pause_ = 0;  // how many it was the last time
};

/// A block of rays of a batch. `skips`: one primitive a ray, never hit by it.
struct RayBlock {
  /// The rays; but if `raw` is set these are that many rays of a float scene within scaled_limits,
  /// and `rays` is where the kernel may put those that it transforms to filter space.
  FilterRay* rays;
  const std::uint32_t* skips;
  std::uint32_t count;
  const Ray<float>* raw = nullptr;
  float scale = 1;
  /// If set, likewise rays in double, all of which this map takes (Kernel::rays_mapped).
  const Ray<double>* raw_doubles = nullptr;
  const space::AffineMap* map = nullptr;
  Sides sides = Sides::Both;  ///< of all of them, as it is in those that are no raw ones
  /// If set, one mask a ray: a certain hit counts only if it has a bit in common with the mask that
  /// the resolver tells. The rays are masked then.
  const std::uint32_t* masks = nullptr;
  /// If set (and `raw` is), a kernel that looks for the closest hits may finish some of them, and
  /// need not say what it found for these. The leaves' copies are exact.
  FinishedHits* finished = nullptr;
  /// Where the caller's next block of rays begins, and the size of one: prefetched
  /// while this block is traversed.
  const std::byte* next = nullptr;
  std::size_t ray_size = 0;
  PacketSchedule* schedule = nullptr;  ///< of the blocks before this one; null: packets are tried
};

/// How many hits are rounded together, and at most how many in one step.
inline constexpr std::size_t kRoundBatch = 32;
inline constexpr std::size_t kRoundStep = 8;

/// Pairs of a ray and a triangle that it surely hits, a pair a column. The rows: corners a, b, c,
/// the ray's origin and its direction, x, y, z of each.
struct alignas(64) HitColumns {
  double number[15][kRoundBatch];
};

/// The numbers of such pairs. Bit i of `sure`: those of pair i are certainly the correctly rounded
/// ones; bit i of `front`: it is hit from the front.
template <class Real>
struct RoundedColumns {
  Real t[kRoundBatch], u[kRoundBatch], v[kRoundBatch], w[kRoundBatch];
  std::uint32_t sure, front;
  /// Bit i: each number of pair i lies in an interval whose lower end rounds to what stands above,
  /// and whose upper end to what stands below. (If it is not set, nothing but `sure` means
  /// anything.)
  std::uint32_t bounded;
  Real t_high[kRoundBatch], u_high[kRoundBatch], v_high[kRoundBatch], w_high[kRoundBatch];
  /// Of floats: the ends of the interval of t.
  double t_from[kRoundBatch], t_to[kRoundBatch];
};

/// What came of a ray's whole way in one go.
enum class Straight : std::uint8_t {
  NotServed,  ///< it has to go step by step
  Miss,
  Hit,
  Rounded,     ///< a hit with its numbers
  NotRounded,  ///< a hit whose numbers are not certain in double
};

/// What is known of the numbers of one hit.
enum class Rounded : std::uint8_t {
  All,
  Ends,  ///< each lies in an interval, of which both ends are rounded
  None,
};

/// What a kernel does for rays of floats and for rays of doubles alike.
template <class Real>
struct RealOps {
  /// Transforms rays of any scene whose affine map is usable: a prefix of them; returns its length.
  /// The next one needs FilterSpace::transform.
  std::size_t (*transform_affine)(const space::AffineMap&, const Ray<Real>*, std::size_t count,
                                  FilterRay*);
  /// Rounds the first `count` pairs. Columns beyond them, up to a whole number of kRoundStep, are
  /// read too.
  void (*round)(const HitColumns&, std::size_t count, RoundedColumns<Real>&);
  /// Rounds one pair, of which weights may be known to be zero (predicate::kZeroU ...). If it is
  /// not certain of all numbers, `high` has the upper ends, and `low` the lower ones.
  Rounded (*round_one)(const predicate::RayD&, const predicate::TriangleD&, std::uint8_t zeros,
                       Hit<Real>& low, Hit<Real>& high);
  /// Of a scene whose affine map is usable: a single ray in its own coordinates, of which nothing
  /// is to be hidden.
  Straight (*closest_straight)(const bvh::Tree&, const space::AffineMap&, const Ray<Real>&,
                               Resolver&, Candidate& winner);
  Straight (*any_straight)(const bvh::Tree&, const space::AffineMap&, const Ray<Real>&, Resolver&);
};

/// Callback of a traversal over a tree whose leaves hold the number of something else each.
class LeafVisitor {
 public:
  /// What is behind number 0, and how far it is from one to the next: three cache lines of it are
  /// prefetched when a leaf comes into sight. `stride` 0: nothing to prefetch.
  const std::byte* first = nullptr;
  std::size_t stride = 0;

  virtual ~LeafVisitor() = default;
  /// The ray may enter the box of this one. Returns where its range ends from now on: minus
  /// infinity to stop.
  virtual float visit(std::uint32_t number) = 0;
};

/// The stack of a traversal.
struct LeafStack {
  struct Entry {
    float tau;  ///< where the ray enters it, or before
    std::uint32_t ref;
  };
  /// Enough for any tree that the builder makes: depth times the seven siblings still to visit.
  static constexpr int kSize = 8 * bvh::kMaxDepth;

  Entry entries[kSize];
  std::uint32_t size;

  /// Starts at the root.
  void start(const bvh::Tree& tree) {
    entries[0] = {-std::numeric_limits<float>::infinity(), tree.root};
    size = tree.root == bvh::kNoChild ? 0 : 1;
  }
};

/// Some of a block's rays in a space of their own: those with these numbers.
struct BlurredBlock {
  const BlurredRay* rays;
  const std::uint32_t* skips;
  const std::uint32_t* numbers;
  std::uint32_t count;
};

/// Of a tree in a space of its own, and a ray that was brought there: as the queries of the same
/// names in Kernel.
struct BlurredOps {
  /// Fills `tau` with where the hit lies.
  Candidate (*closest)(const bvh::Tree&, const BlurredRay&, std::uint32_t skip, Resolver&,
                       TauInterval& tau, KernelCounts*);
  bool (*any)(const bvh::Tree&, const BlurredRay&, std::uint32_t skip, Resolver&, KernelCounts*);
  void (*all)(const bvh::Tree&, const BlurredRay&, std::uint32_t skip, CandidateSink&,
              KernelCounts*);
  /// Visits all that lies in leaves which the ray may enter, nearest leaves first.
  void (*visit)(const bvh::Tree&, const FilterRay&, LeafVisitor&, KernelCounts*);
  /// The same step by step: the next leaf's reference, kNoChild if there is none before `tau_max`.
  std::uint32_t (*next)(const bvh::Tree&, const FilterRay&, float tau_max, LeafStack&,
                        KernelCounts*);
  /// Of these rays, interleaved. Outputs have the block's numbers.
  void (*closest_block)(const bvh::Tree&, const BlurredBlock&, Resolver&, Candidate* out,
                        TauInterval* taus, KernelCounts*);
  void (*any_block)(const bvh::Tree&, const BlurredBlock&, Resolver&, std::uint8_t* out,
                    KernelCounts*);
};

struct Kernel {
  const char* name;
  RealOps<float> floats;
  RealOps<double> doubles;
  /// Transforms rays of a float scene that is only scaled (by `scale`) into filter space: a prefix
  /// of them; returns its length. The next one needs FilterSpace::transform.
  std::size_t (*transform_scaled)(float scale, const Ray<float>*, std::size_t count, FilterRay*);
  /// Whether all rays are within the limits, and no end of a range is NaN. May say no for no
  /// reason.
  bool (*rays_within)(const RayLimits&, const Ray<float>*, std::size_t count);
  /// Whether transform_affine takes all of them.
  bool (*rays_mapped)(const space::AffineMap&, const Ray<double>*, std::size_t count);
  /// Rounds a hit of a float scene's exact ray, from the triangle's copy; only one that a kernel
  /// was certain of. False if the numbers are not certain.
  bool (*round_copy)(const FilterRay&, const Candidate&, Hit<float>&);
  /// Whether a pair is a hit, in double and with more bits; fills an interval that holds its t.
  predicate::Certified (*decide_pair)(const predicate::RayD&, const predicate::TriangleD&,
                                      predicate::Interval& t);
  /// Rounds a pair of which double arithmetic is not certain, with more bits; false if that is not
  /// certain either.
  bool (*round_finely)(const predicate::RayD&, const predicate::TriangleD&, std::uint8_t zeros,
                       Hit<float>&);
  /// As RealOps::round_one of a ray and a triangle where they lie: what has just been copied would
  /// be waited for.
  bool (*round_in_place)(const Ray<double>&, const Vec3<double>& a, const Vec3<double>& b,
                         const Vec3<double>& c, Hit<double>&);
  /// The same of a triangle's copy, times the power of two `unscale`.
  bool (*round_unscaled)(const Ray<double>&, const Candidate&, double unscale, Hit<double>&);
  /// The same of a float scene that is only scaled and has copies of its triangles. A hit that is
  /// Rounded lacks nothing but the triangle's name.
  Straight (*closest_scaled)(const bvh::Tree&, float scale, const Ray<float>&, Resolver&,
                             Candidate& winner, Hit<float>&);
  Straight (*any_scaled)(const bvh::Tree&, float scale, const Ray<float>&, Resolver&);
  /// The first hit triangle (primitive == kNone: none). `skip` is never hit.
  Candidate (*closest)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Resolver&,
                       KernelCounts*);
  /// Whether any triangle is hit.
  bool (*any)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Resolver&, KernelCounts*);
  /// The same for a block of rays: coherent neighbours as packets (of a packet's node or leaf one
  /// visit is counted), the others interleaved.
  void (*closest_block)(const bvh::Tree&, const RayBlock&, Resolver&, Candidate* out,
                        KernelCounts*);
  void (*any_block)(const bvh::Tree&, const RayBlock&, Resolver&, std::uint8_t* out, KernelCounts*);
  /// Calls the sink for every triangle that may be hit, in no order.
  void (*all)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, CandidateSink&,
              KernelCounts*);
  BlurredOps blurred;
  /// Questions about points.
  AxisTraversal axis;
  NearestTraversal nearest;
  WindingTraversal winding;

  template <class Real>
  [[nodiscard]] const RealOps<Real>& of() const {
    if constexpr (std::is_same_v<Real, float>) {
      return floats;
    } else {
      return doubles;
    }
  }
};

/// The kernel that queries use: the one that the environment variable PIERCE_KERNEL names, else the
/// widest that this machine runs. Throws Error (UnknownKernel) if that name is not one of
/// `kernels()`.
const Kernel& active_kernel();

/// All kernels that this machine runs, the best first; "plain" is always the last.
std::span<const Kernel* const> kernels();

}  // namespace pierce::kernels
