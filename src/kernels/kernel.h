// SPDX-License-Identifier: Apache-2.0
//
// What a kernel is: the wide part of a query, in float, in filter space. A kernel traverses the
// tree and discards what cannot be hit; candidates that float cannot decide go to a callback, the
// exact Resolver, which is never wrong. So no kernel can make an answer wrong, save by discarding
// too much or by being certain too soon; the bounds that rule this out are in bounds.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "bvh/tree.h"
#include "pierce/options.h"
#include "predicate/types.h"
#include "space/filter_space.h"

namespace pierce::kernels {

/// A ray for the float rung. The true range lies within [tau_min, tau_max] and holds
/// [tau_first, tau_last].
struct alignas(16) FilterRay {
  float origin[4];  // x, y, z and a number that is not used
  float direction[4];
  float tau_min, tau_max;
  float tau_first, tau_last;
  bool exact;        // nothing was rounded: neither here nor in the leaves' copies
  double tau_scale;  // of an exact ray: tau = t * tau_scale, a power of two
};

/// A triangle that a kernel has met, and its float copy in the leaf: component k of the corners (ax
/// ay az bx by bz cx cy cz) is copy[k * stride]. A tree that keeps no copies (Layout::Compact) has
/// one only while its leaf is looked at: whoever keeps the candidate goes by the number.
struct Candidate {
  std::uint32_t primitive = kNone;
  std::uint32_t stride = 0;
  const float* copy = nullptr;
};

/// Where on the ray a hit lies: low <= tau <= high.
struct TauInterval {
  float low, high;
};

/// Decides what float cannot. All methods are exact.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// Whether the ray hits the triangle; fills `tau` if so.
  virtual bool is_hit(const Candidate& candidate, TauInterval& tau) = 0;
  /// Of two hits, whether the challenger comes before the best one so far: smaller t, or of equal t
  /// the smaller number.
  virtual bool is_before(const Candidate& challenger, const Candidate& best) = 0;
};

/// Callback of a traversal for all hits.
class CandidateSink {
 public:
  virtual ~CandidateSink() = default;
  /// The ray may hit this triangle. Called once for each candidate; one in two leaves comes twice.
  virtual void add(const Candidate& candidate) = 0;
};

/// The magnitudes of the components of an origin are at most `origin`, those of a direction at most
/// `greatest`, and one of them is at least `least`.
template <class Real>
struct RayLimits {
  Real origin, least, greatest;
};

/// Those of every valid ray.
template <class Real>
inline constexpr RayLimits<Real> kValidRay = {std::numeric_limits<Real>::max(),
                                              std::numeric_limits<Real>::denorm_min(),
                                              std::numeric_limits<Real>::max()};

/// Within which scaling by powers of two is exact.
[[nodiscard]] inline RayLimits<float> scaled_limits(float scale) {
  return {bvh::kNearOrigin / scale, 0x1p-119F, 0x1.fffffep119F};
}

/// How many rays a kernel takes at once at most.
inline constexpr std::uint32_t kBlockSize = 256;

/// What a kernel writes by itself of a block's hits. The numbers are certain; the names are as if
/// all triangles were of one geometry.
struct FinishedHits {
  Hit<float>* hits = nullptr;                ///< one a ray of the block
  std::uint64_t rays[kBlockSize / 64] = {};  ///< bit i % 64 of word i / 64: hit i is written
  std::uint32_t found = 0;                   ///< how many of these are no misses
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
  /// If set (and `raw` is), a kernel that looks for the closest hits may finish some of them, and
  /// need not say what it found for these. The leaves' copies are exact.
  FinishedHits* finished = nullptr;
  /// Where the caller's next block of rays begins, and the size of one: prefetched
  /// while this block is traversed.
  const std::byte* next = nullptr;
  std::size_t ray_size = 0;
};

/// The resolvers of the rays of a block, by their index in it.
class Resolvers {
 public:
  virtual ~Resolvers() = default;
  virtual Resolver& of(std::uint32_t ray) = 0;
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
/// ones (otherwise they mean nothing); bit i of `front`: it is hit from the front.
template <class Real>
struct RoundedColumns {
  Real t[kRoundBatch], u[kRoundBatch], v[kRoundBatch], w[kRoundBatch];
  std::uint32_t sure, front;
};

/// Counts of one query or batch, added to.
struct KernelCounts {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t candidates = 0;
};

struct Kernel {
  const char* name;
  /// Rays of a float scene that is only scaled (by `scale`) into filter space. Transforms a prefix
  /// of the rays and returns its length: all, or those before the first that needs
  /// FilterSpace::transform.
  std::size_t (*transform_scaled)(float scale, const Ray<float>*, std::size_t count, FilterRay*);
  /// The same for rays of any scene whose affine map is usable.
  std::size_t (*transform_affine_float)(const bvh::AffineMap&, const Ray<float>*, std::size_t count,
                                        FilterRay*);
  std::size_t (*transform_affine_double)(const bvh::AffineMap&, const Ray<double>*,
                                         std::size_t count, FilterRay*);
  /// Whether all rays are within the limits, and no end of a range is NaN. May say no for no
  /// reason.
  bool (*rays_within_float)(const RayLimits<float>&, const Ray<float>*, std::size_t count);
  bool (*rays_within_double)(const RayLimits<double>&, const Ray<double>*, std::size_t count);
  /// The first hit triangle (primitive == kNone: none). `skip` is never hit.
  Candidate (*closest)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Resolver&,
                       KernelCounts*);
  /// Whether any triangle is hit.
  bool (*any)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Resolver&, KernelCounts*);
  /// The same for a block of rays: coherent neighbours as packets (of a packet's node or leaf
  /// one visit is counted), the others interleaved.
  void (*closest_block)(const bvh::Tree&, const RayBlock&, Resolvers&, Candidate* out,
                        KernelCounts*);
  void (*any_block)(const bvh::Tree&, const RayBlock&, Resolvers&, std::uint8_t* out,
                    KernelCounts*);
  /// Calls the sink for every triangle that may be hit, in no order.
  void (*all)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, CandidateSink&,
              KernelCounts*);
  /// Rounds the first `count` pairs. Columns beyond them, up to a whole number of kRoundStep, are
  /// read too.
  void (*round_float)(const HitColumns&, std::size_t count, RoundedColumns<float>&);
  void (*round_double)(const HitColumns&, std::size_t count, RoundedColumns<double>&);
  /// Rounds one pair; false if that is not certain.
  bool (*round_one_float)(const predicate::RayD&, const predicate::TriangleD&, Hit<float>&);
  bool (*round_one_double)(const predicate::RayD&, const predicate::TriangleD&, Hit<double>&);
  /// The same for a hit of a float scene's exact ray, from the triangle's copy; only for one that a
  /// kernel was certain of.
  bool (*round_copy)(const FilterRay&, const Candidate&, Hit<float>&);

  std::size_t transform_affine(const bvh::AffineMap& space, const Ray<float>* rays,
                               std::size_t count, FilterRay* out) const {
    return transform_affine_float(space, rays, count, out);
  }
  std::size_t transform_affine(const bvh::AffineMap& space, const Ray<double>* rays,
                               std::size_t count, FilterRay* out) const {
    return transform_affine_double(space, rays, count, out);
  }
  [[nodiscard]] bool rays_within(const RayLimits<float>& limits, const Ray<float>* rays,
                                 std::size_t count) const {
    return rays_within_float(limits, rays, count);
  }
  [[nodiscard]] bool rays_within(const RayLimits<double>& limits, const Ray<double>* rays,
                                 std::size_t count) const {
    return rays_within_double(limits, rays, count);
  }
  [[nodiscard]] bool round_one(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                               Hit<float>& hit) const {
    return round_one_float(ray, triangle, hit);
  }
  [[nodiscard]] bool round_one(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                               Hit<double>& hit) const {
    return round_one_double(ray, triangle, hit);
  }
  void round(const HitColumns& hits, std::size_t count, RoundedColumns<float>& out) const {
    round_float(hits, count, out);
  }
  void round(const HitColumns& hits, std::size_t count, RoundedColumns<double>& out) const {
    round_double(hits, count, out);
  }
};

/// The kernel that queries use: the one that the environment variable PIERCE_KERNEL names, else the
/// widest that this machine runs. Throws Error (UnknownKernel) if that name is not one of
/// `kernels()`.
const Kernel& active_kernel();

/// All kernels that this machine runs, the best first; "plain" is always the last.
std::span<const Kernel* const> kernels();

}  // namespace pierce::kernels
