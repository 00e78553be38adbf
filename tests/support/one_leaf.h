// SPDX-License-Identifier: Apache-2.0
//
// The smallest tree there is, one leaf (or one node above it), asked directly through a kernel: for
// tests that attack the bounds of the float rung. The data are exact numbers of filter space, as
// doubles; what the kernel sees is what the builder and filter_ray make of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "bvh/box.h"
#include "bvh/child_order.h"
#include "bvh/leaf_block.h"
#include "bvh/tree.h"
#include "kernels/kernel.h"
#include "predicate/settle.h"
#include "space/filter_ray.h"

namespace pierce::attack {

/// Exact data: corners within 1, the ray's origin within 2, its direction's max-norm in [1, 2), all
/// of them doubles; t is tau.
struct LeafCase {
  predicate::RayD ray;
  std::vector<predicate::TriangleD> triangles;  // 1 to 8
};

/// The same, 2^k times as small; t is tau still.
inline void make_smaller(int k, predicate::RayD& ray,
                         std::vector<predicate::TriangleD>& triangles) {
  const double scale = std::ldexp(1.0, -k);
  const auto shrink = [scale](Vec3<double>& p) { p = {p.x * scale, p.y * scale, p.z * scale}; };
  shrink(ray.origin);
  ray.t_min *= scale;
  ray.t_max *= scale;
  for (predicate::TriangleD& t : triangles) {
    shrink(t.a);
    shrink(t.b);
    shrink(t.c);
  }
}

class Corners final : public bvh::Primitives {
 public:
  explicit Corners(const std::vector<predicate::TriangleD>& triangles) : triangles_(triangles) {}
  [[nodiscard]] std::uint32_t size() const override {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  [[nodiscard]] bvh::Corners corners(std::uint32_t i) const override {
    return {triangles_[i].a, triangles_[i].b, triangles_[i].c};
  }

 private:
  const std::vector<predicate::TriangleD>& triangles_;
};

/// A tree whose root is a leaf with all the triangles.
inline bvh::Tree one_leaf(const std::vector<predicate::TriangleD>& triangles) {
  const Corners corners(triangles);
  std::uint32_t numbers[bvh::kWidth] = {0, 1, 2, 3, 4, 5, 6, 7};
  bvh::Tree tree;
  const std::size_t bytes =
      std::size_t{bvh::leaf_units(bvh::Layout::Full, corners.size())} * bvh::kLeafUnit;
  tree.leaves = bvh::HugeBuffer<std::byte>(bytes + bvh::kLeafSlack);
  std::memset(tree.leaves.data(), 0, bytes + bvh::kLeafSlack);
  bvh::write_leaf_block(bvh::Layout::Full, tree.leaves.data(), corners, numbers, corners.size());
  tree.root = bvh::make_leaf(0, corners.size());
  return tree;
}

/// The same below one node, whose only child has the box of the leaf.
inline bvh::Tree one_node(const std::vector<predicate::TriangleD>& triangles) {
  bvh::Tree tree = one_leaf(triangles);
  bvh::Box tight;
  for (const predicate::TriangleD& t : triangles) tight.grow(bvh::box_of({t.a, t.b, t.c}));
  const bvh::Box box = bvh::padded(tight);
  tree.nodes = bvh::HugeBuffer<bvh::Node>(1);
  bvh::Node& node = tree.nodes[0];
  for (int lane = 0; lane < bvh::kWidth; ++lane) {
    for (int axis = 0; axis < 3; ++axis) {
      node.lower[axis][lane] = lane == 0 ? box.lower[axis] : bvh::kEmptyPlane;
      node.upper[axis][lane] = lane == 0 ? box.upper[axis] : -bvh::kEmptyPlane;
    }
    node.child[lane] = lane == 0 ? tree.root : bvh::kNoChild;
  }
  bvh::order_children(node);
  tree.root = 0;
  return tree;
}

/// `kept`: the origin is the ray's own, and the leaf's copies are exact if they can be.
inline space::FilterRay filter_ray(const predicate::RayD& ray, bool kept) {
  const auto limit = static_cast<double>(space::kTauLimit);
  space::TransformedRay transformed{};
  transformed.origin = ray.origin;
  transformed.direction = ray.direction;
  transformed.tau_min = std::clamp(ray.t_min, -limit, limit);
  transformed.tau_max = std::clamp(ray.t_max, -limit, limit);
  transformed.origin_kept = kept;
  return space::filter_ray(transformed, kept);
}

inline bool is_float(const predicate::TriangleD& t) {
  return space::is_float(t.a) && space::is_float(t.b) && space::is_float(t.c);
}

/// Never wrong about the case's ray, which all rays of a block are taken for; tells nothing of
/// where a hit lies, and remembers what it was asked about ray 0.
class Recorder final : public kernels::Resolver {
 public:
  explicit Recorder(const LeafCase& c) : case_(c) {}

  bool is_hit(std::uint32_t ray, const kernels::Candidate& candidate,
              kernels::TauInterval& tau) override {
    if (ray == 0) asked |= 1U << candidate.primitive;
    tau = {-space::kTauLimit, space::kTauLimit};
    return predicate::settle_hit(case_.ray, case_.triangles[candidate.primitive]).hit;
  }
  bool is_before(std::uint32_t, const kernels::Candidate& challenger,
                 const kernels::Candidate& best) override {
    const auto order = predicate::settle_order(case_.ray, case_.triangles[challenger.primitive],
                                               case_.triangles[best.primitive]);
    return order < 0 || (order == 0 && challenger.primitive < best.primitive);
  }

  std::uint32_t asked = 0;  // bit i: about triangle i

 private:
  const LeafCase& case_;
};

/// Remembers the candidates.
struct Collected final : kernels::CandidateSink {
  void add(const kernels::Candidate& candidate, bool /*certain*/) override {
    triangles |= 1U << candidate.primitive;
  }
  std::uint32_t triangles = 0;  // a bit each
};

/// What is true of a case.
struct Truth {
  std::uint32_t hits = 0;         // bit i: triangle i is hit
  std::uint32_t closest = kNone;  // the first of them

  explicit Truth(const LeafCase& c) {
    for (std::uint32_t i = 0; i < c.triangles.size(); ++i) {
      if (!predicate::settle_hit(c.ray, c.triangles[i]).hit) continue;
      hits |= 1U << i;
      if (closest == kNone ||
          predicate::settle_order(c.ray, c.triangles[i], c.triangles[closest]) < 0) {
        closest = i;
      }
    }
  }
};

/// How rays of a batch go: sixteen coherent ones as a packet, others interleaved.
enum class Block : std::uint8_t { Packet, Interleaved };

/// One ray of a case among others in a block: as many of itself as make a packet, or with one that
/// runs the other way and hits nothing.
class BlockOfOne {
 public:
  BlockOfOne(const LeafCase& c, const space::FilterRay& ray, Block block)
      : rays_(16, ray), skips_(16, kNone), recorder_(c) {
    if (block == Block::Packet) return;
    rays_.resize(2);
    space::FilterRay& other = rays_.back();
    for (float& x : other.direction) x = -x;
    other.tau_min = other.tau_first = space::kTauLimit;
    other.tau_max = other.tau_last = -space::kTauLimit;
  }
  [[nodiscard]] std::uint32_t closest(const kernels::Kernel& kernel, const bvh::Tree& tree) {
    std::vector<kernels::Candidate> out(rays_.size());
    kernel.closest_block(tree, view(), recorder_, out.data(), nullptr);
    return out[0].primitive;
  }
  [[nodiscard]] bool any(const kernels::Kernel& kernel, const bvh::Tree& tree) {
    std::vector<std::uint8_t> out(rays_.size());
    kernel.any_block(tree, view(), recorder_, out.data(), nullptr);
    return out[0] != 0;
  }

 private:
  [[nodiscard]] kernels::RayBlock view() {
    return {rays_.data(), skips_.data(), static_cast<std::uint32_t>(rays_.size())};
  }

  std::vector<space::FilterRay> rays_;
  std::vector<std::uint32_t> skips_;
  Recorder recorder_;
};

/// What a kernel got wrong of a block, or nullptr.
inline const char* first_error_of_block(const kernels::Kernel& kernel, const bvh::Tree& tree,
                                        const LeafCase& c, const Truth& truth,
                                        const space::FilterRay& ray, Block block) {
  const bool packet = block == Block::Packet;
  if (BlockOfOne(c, ray, block).any(kernel, tree) != (truth.hits != 0)) {
    return packet ? "packet: any is wrong" : "interleaved: any is wrong";
  }
  if (BlockOfOne(c, ray, block).closest(kernel, tree) != truth.closest) {
    return packet ? "packet: closest is wrong" : "interleaved: closest is wrong";
  }
  return nullptr;
}

/// What a kernel got wrong, or nullptr. `asked` gathers how often it asked.
inline const char* first_error(const kernels::Kernel& kernel, const bvh::Tree& tree,
                               const LeafCase& c, const Truth& truth, bool kept,
                               std::uint64_t& asked) {
  const space::FilterRay ray = filter_ray(c.ray, kept);
  Collected all;
  kernel.all(tree, ray, kNone, all, nullptr);
  if ((truth.hits & ~all.triangles) != 0) return "all: a hit was culled";
  Recorder any(c);
  if (kernel.any(tree, ray, kNone, any, nullptr) != (truth.hits != 0)) {
    return truth.hits != 0 ? "any: a hit was culled" : "any: certain of a miss";
  }
  Recorder closest(c);
  const std::uint32_t found = kernel.closest(tree, ray, kNone, closest, nullptr).primitive;
  if (found != truth.closest) {
    if (found == kNone) return "closest: a hit was culled";
    if (((truth.hits >> found) & 1U) == 0) return "closest: certain of a miss";
    return "closest: not the first";
  }
  asked += closest.asked != 0 ? 1 : 0;
  for (const Block block : {Block::Packet, Block::Interleaved}) {
    const char* error = first_error_of_block(kernel, tree, c, truth, ray, block);
    if (error != nullptr) return error;
  }
  return nullptr;
}

/// What is true, and what a kernel sees of it: every corner off by a little, and the ray's origin;
/// by no more than `blur` together.
struct BlurredCase {
  LeafCase c, seen;
  float blur;
};

/// What a kernel got wrong of that, or nullptr.
inline const char* first_error(const kernels::Kernel& kernel, const BlurredCase& blurred,
                               const Truth& truth, std::uint64_t& asked) {
  const bvh::Tree tree = one_node(blurred.seen.triangles);
  space::BlurredRay ray{filter_ray(blurred.seen.ray, false), blurred.blur};
  ray.exact = false;
  const kernels::BlurredOps& ops = kernel.blurred;
  Collected all;
  ops.all(tree, ray, kNone, all, nullptr);
  if ((truth.hits & ~all.triangles) != 0) return "all: a hit was culled";
  Recorder any(blurred.c);
  if (ops.any(tree, ray, kNone, any, nullptr) != (truth.hits != 0)) {
    return truth.hits != 0 ? "any: a hit was culled" : "any: certain of a miss";
  }
  Recorder closest(blurred.c);
  kernels::TauInterval tau{};
  const std::uint32_t found = ops.closest(tree, ray, kNone, closest, tau, nullptr).primitive;
  if (found != truth.closest) return "closest: wrong";
  asked += closest.asked != 0 ? 1 : 0;
  if (found != kNone) {
    predicate::RayD end = blurred.c.ray;
    end.t_max = static_cast<double>(tau.high);
    predicate::RayD start = blurred.c.ray;
    start.t_min = static_cast<double>(tau.low);
    const predicate::TriangleD& t = blurred.c.triangles[found];
    if (!predicate::settle_hit(end, t).hit || !predicate::settle_hit(start, t).hit)
      return "closest: not where it says";
  }
  const std::uint32_t skip = kNone, number = 0;
  const kernels::BlurredBlock block{&ray, &skip, &number, 1};
  Recorder in_block(blurred.c);
  kernels::Candidate winner;
  ops.closest_block(tree, block, in_block, &winner, &tau, nullptr);
  if (winner.primitive != truth.closest) return "interleaved: closest is wrong";
  std::uint8_t any_found = 0;
  ops.any_block(tree, block, in_block, &any_found, nullptr);
  return (any_found != 0) == (truth.hits != 0) ? nullptr : "interleaved: any is wrong";
}

}  // namespace pierce::attack
