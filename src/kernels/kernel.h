// SPDX-License-Identifier: Apache-2.0
//
// What a kernel is: the wide part of a query, in float, in filter space. A kernel walks the tree
// and discards what cannot be hit; whatever it cannot tell it asks a Referee, who is never wrong.
// So no kernel can make an answer wrong, save by discarding too much.
#pragma once

#include <cstdint>

#include "bvh/filter_space.h"
#include "bvh/tree.h"
#include "pierce/options.h"

namespace pierce::kernels {

/// The box test's bound for everything that is rounded on the way: box, origin, direction,
/// reciprocal, and the test itself come to 14 * 2^-24 (docs/algorithm.md, "The box test").
inline constexpr float kBoxPad = 0x1p-20F;

/// Direction components smaller than this in magnitude count as this in the box test: no division
/// by zero, no NaN. Over |tau| <= 4 this moves a point by 2^-58.
inline constexpr float kSmallestSlope = 0x1p-60F;

/// A ray for the float rung.
struct FilterRay {
  float origin[3];
  float direction[3];
  float tau_min, tau_max;
};

FilterRay filter_ray(const bvh::PlacedRay& placed);

/// Where on the ray a hit lies: low <= tau <= high.
struct TauInterval {
  float low, high;
};

/// Decides what float cannot. All methods are exact.
class Referee {
 public:
  virtual ~Referee() = default;
  /// Whether the ray hits the triangle; fills `tau` if so.
  virtual bool is_hit(std::uint32_t primitive, TauInterval& tau) = 0;
  /// Of two hits, whether the challenger comes before the best one so far: smaller t, or of equal t
  /// the smaller number.
  virtual bool is_before(std::uint32_t challenger, std::uint32_t best) = 0;
};

/// Counts of one query or batch, added to.
struct KernelCounts {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t candidates = 0;
};

struct Kernel {
  const char* name;
  /// The number of the first hit triangle, or kNone. `skip` is never hit.
  std::uint32_t (*closest)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Referee&,
                           KernelCounts*);
  /// Whether any triangle is hit.
  bool (*any)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Referee&, KernelCounts*);
  /// Asks the referee about every triangle that may be hit; a triangle may be asked about twice.
  void (*all)(const bvh::Tree&, const FilterRay&, std::uint32_t skip, Referee&, KernelCounts*);
};

}  // namespace pierce::kernels
