// SPDX-License-Identifier: Apache-2.0
//
// A block of rays in two levels, round by round: in each, every ray goes on to the next place that
// it may enter, and those that have come to the same mesh's tree are traversed there together,
// interleaved, however that mesh is placed for each of them. Where trees are small there is nothing
// to wait for, and rays go one by one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "scene/rays/two_level_query.h"

namespace pierce::scene {

/// `Query` is a BlockQuery. One object serves one block.
template <class Real, class Query>
class TwoLevelBlock final : public kernels::Resolver {
 public:
  TwoLevelBlock(const kernels::Kernel& kernel, const TwoLevel<Real>& two_level, Query& query)
      : kernel_(kernel), two_level_(two_level), query_(query) {}

  /// The winners of the query's rays, by the scene's numbers.
  void closest(const kernels::RayBlock& block, kernels::Candidate* winners,
               kernels::KernelCounts* counts) {
    if (!two_level_.goes_together()) {
      return one_by_one(block, counts, [&](const auto& ray, std::uint32_t i, const auto& ladder) {
        winners[i] = ray.closest(ladder);
        query_.keep_zeros(i, winners[i].primitive);
      });
    }
    run(block, counts, [&](const Placed* of_bottom, const kernels::BlurredBlock& there) {
      kernel_.blurred.closest_block(two_level_.bottom(*of_bottom).tree, there, *this, found_.data(),
                                    taus_.data(), counts);
      for (std::uint32_t i = 0; i < there.count; ++i) {
        const std::uint32_t number = there.numbers[i];
        RayState& ray = rays_[number];
        kernels::Candidate found = found_[number];
        if (found.primitive == kNone) continue;
        found.primitive += ray.placed->first;
        offer(number, found, ray.local.scene_low(taus_[number].low),
              ray.local.scene_high(taus_[number].high));
      }
    });
    for (std::uint32_t i = 0; i < block.count; ++i) winners[i] = rays_[i].first.hit;
  }

  /// 1 for each ray with a hit.
  void any(const kernels::RayBlock& block, std::uint8_t* hits, kernels::KernelCounts* counts) {
    if (!two_level_.goes_together()) {
      return one_by_one(block, counts, [&](const auto& ray, std::uint32_t i, const auto& ladder) {
        hits[i] = ray.any(ladder) ? 1 : 0;
      });
    }
    run(block, counts, [&](const Placed* of_bottom, const kernels::BlurredBlock& there) {
      kernel_.blurred.any_block(two_level_.bottom(*of_bottom).tree, there, *this, any_.data(),
                                counts);
      for (std::uint32_t i = 0; i < there.count; ++i) {
        RayState& ray = rays_[there.numbers[i]];
        if (any_[there.numbers[i]] == 0) continue;
        ray.first.hit.primitive = ray.placed->first;  // some one
        ray.first.end = -FirstOfPlaces::kNever;
      }
    });
    for (std::uint32_t i = 0; i < block.count; ++i) hits[i] = rays_[i].first.hit.primitive != kNone;
  }

  bool is_hit(std::uint32_t number, const kernels::Candidate& candidate,
              kernels::TauInterval& tau) override {
    const RayState& ray = rays_[number];
    double low = 0, high = 0;
    if (!is_scene_hit(ladder(number), ray.scene, of_scene(ray, candidate), low, high)) return false;
    query_.keep_zeros(number, of_scene(ray, candidate).primitive);
    const space::LocalRay::Ends ends = ray.local.outward(low, high);
    tau = {ends.low, ends.high};
    return true;
  }
  bool is_before(std::uint32_t number, const kernels::Candidate& challenger,
                 const kernels::Candidate& best) override {
    const RayState& ray = rays_[number];
    return is_before_in_scene(number, of_scene(ray, challenger), of_scene(ray, best));
  }

 private:
  static constexpr std::uint32_t kRays = kernels::kBlockSize;

  struct RayState {
    space::TransformedRay scene;
    space::LocalRay local;  // where it is now ...
    const Placed* placed;   // ... and whose space that is
    FirstOfPlaces first;
    kernels::LeafStack stack;
  };

  // A thread's, for one block after the other: it is large.
  static RayState* room() {
    static thread_local const std::unique_ptr<RayState[]> kRoom(new RayState[kRays]);
    return kRoom.get();
  }

  RayLadder<Real>& ladder(std::uint32_t number) { return query_.ladder_of(number); }
  static kernels::Candidate of_scene(const RayState& ray, kernels::Candidate candidate) {
    candidate.primitive += ray.placed->first;
    return candidate;
  }

  bool is_before_in_scene(std::uint32_t number, const kernels::Candidate& challenger,
                          const kernels::Candidate& best) {
    const bool before = ladder(number).is_before(challenger, best);
    query_.keep_zeros(number, before ? challenger.primitive : best.primitive);
    return before;
  }

  void offer(std::uint32_t number, const kernels::Candidate& found, double low, double high) {
    FirstOfPlaces& first = rays_[number].first;
    first.offer(found, low, high, [&](const auto& challenger, const auto& best) {
      return is_before_in_scene(number, challenger, best);
    });
  }

  // `ask(two_level_ray, number, ladder)` for each.
  template <class Ask>
  void one_by_one(const kernels::RayBlock& block, kernels::KernelCounts* counts, const Ask& ask) {
    for (std::uint32_t i = 0; i < block.count; ++i) {
      const space::TransformedRay scene = query_.transformed(i);
      ask(TwoLevelRay<Real>{kernel_, two_level_, block.rays[i], scene, block.skips[i],
                            query_.unlimited(i), counts},
          i, [&]() -> RayLadder<Real>& { return ladder(i); });
    }
  }

  // `traverse(placed, block)`: rays that have come to one mesh's tree, that of this place too.
  template <class Traverse>
  void run(const kernels::RayBlock& block, kernels::KernelCounts* counts,
           const Traverse& traverse) {
    std::uint32_t active = block.count;
    for (std::uint32_t i = 0; i < block.count; ++i) {
      RayState& ray = rays_[i];
      ray.scene = query_.transformed(i);
      ray.first = {};
      ray.stack.start(two_level_.top());
      active_[i] = i;
    }
    while (active != 0) {
      std::uint32_t going = 0;
      for (std::uint32_t i = 0; i < active; ++i) {
        if (enter_next(active_[i], block, counts)) active_[going++] = active_[i];
      }
      active = going;
      traverse_each(active, traverse);
    }
  }

  // Brings the ray to the next place; false if there is none.
  bool enter_next(std::uint32_t number, const kernels::RayBlock& block,
                  kernels::KernelCounts* counts) {
    RayState& ray = rays_[number];
    const bvh::Tree& top = two_level_.top();
    for (;;) {
      const std::uint32_t leaf = kernel_.blurred.next(
          top, block.rays[number], float_end(ray.scene, ray.first.end), ray.stack, counts);
      if (leaf == bvh::kNoChild) return false;
      ray.placed = &two_level_.placed(*bvh::leaf_numbers(top, leaf));
      const space::Brought brought = ray.placed->space.bring(ray.scene, ray.local);
      if (brought == space::Brought::Misses) continue;
      if (brought == space::Brought::Unknown) {
        ask_each(number, block.skips[number]);
        continue;
      }
      ray.first.limit(ray.local, query_.unlimited(number));
      local_rays_[number] = ray.local.ray;
      skips_[number] = ray.placed->local(block.skips[number]);
      return true;
    }
  }

  // Where no float can tell anything.
  void ask_each(std::uint32_t number, std::uint32_t skip) {
    RayState& ray = rays_[number];
    two_level_.for_each_triangle(*ray.placed, [&](std::uint32_t primitive) {
      const kernels::Candidate candidate{primitive, 0, nullptr};
      double low = 0, high = 0;
      if (primitive != skip && is_scene_hit(ladder(number), ray.scene, candidate, low, high)) {
        offer(number, candidate, low - kTauOff, high + kTauOff);
      }
      return false;
    });
  }

  template <class Traverse>
  void traverse_each(std::uint32_t active, const Traverse& traverse) {
    std::uint32_t* rest = active_.data();
    std::uint32_t* const end = rest + active;
    while (rest != end) {
      const Placed* placed = rays_[*rest].placed;
      // Those of the same mesh to the front, in their order.
      const auto same = std::stable_partition(rest, end, [&](std::uint32_t number) {
        return rays_[number].placed->bottom == placed->bottom;
      });
      traverse(placed, kernels::BlurredBlock{local_rays_.data(), skips_.data(), rest,
                                             static_cast<std::uint32_t>(same - rest)});
      rest = same;
    }
  }

  const kernels::Kernel& kernel_;
  const TwoLevel<Real>& two_level_;
  Query& query_;
  RayState* const rays_ = room();
  std::array<space::BlurredRay, kRays> local_rays_;
  std::array<std::uint32_t, kRays> skips_, active_;
  std::array<kernels::Candidate, kRays> found_;
  std::array<kernels::TauInterval, kRays> taus_;
  std::array<std::uint8_t, kRays> any_;
};

}  // namespace pierce::scene
