// SPDX-License-Identifier: Apache-2.0
//
// A block of rays of a batch on their way through a scene.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>

#include "kernels/kernel.h"
#include "scene/rays/hit_rounding.h"
#include "scene/rays/ladder_resolver.h"
#include "scene/rays/ray_transform.h"
#include "scene/rays/sight.h"
#include "scene/validate_input.h"

namespace pierce::scene {

template <class Real>
class BlockQuery {
 public:
  /// `may_be_raw`: whoever traverses takes rays as they come.
  BlockQuery(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
             const BatchOptions& options, bool may_be_raw, kernels::PacketSchedule& schedule,
             predicate::LadderCounts& counts)
      : kernel_(kernel),
        geometries_(geometries),
        options_(options),
        counts_(counts),
        may_be_raw_(may_be_raw),
        schedule_(schedule),
        resolver_(*this) {}
  BlockQuery(const BlockQuery&) = delete;
  BlockQuery& operator=(const BlockQuery&) = delete;

  /// Starts on other rays of the batch, at most kBlockSize: those from number `first` on. False if
  /// one of them is not valid.
  [[nodiscard]] bool start(std::span<const Ray<Real>> rays, std::size_t first) {
    rays_ = rays;
    first_ = first;
    size_ = 0;
    placed_exactly_ = 0;
    finished_ = {};
    masked_ = !all_seen();
    // Of use to packets only.
    raw_ = may_be_raw_ && !schedule_.rests() && taken_raw(rays);
    if (raw_) {
      size_ = static_cast<std::uint32_t>(rays.size());
      std::iota(ray_of_.begin(), ray_of_.begin() + size_, 0U);
    } else if (!transform_rays()) {
      return false;
    }
    resolver_.start(size_);
    if (masked_) {
      for (std::uint32_t i = 0; i < size_; ++i) masks_[i] = mask(i);
    }
    std::fill_n(skips_.data(), size_, kNone);
    if (options_.skip.empty()) return true;
    for (std::uint32_t i = 0; i < size_; ++i) {
      skips_[i] = geometries_.primitive(options_.skip[first_ + ray_of_[i]]);
    }
    return true;
  }

  [[nodiscard]] kernels::Resolver& resolver() { return resolver_; }

  /// For two levels.
  RayLadder<Real>& ladder_of(std::uint32_t ray) { return resolver_.ladder(ray); }
  void keep_zeros(std::uint32_t ray, std::uint32_t primitive) {
    resolver_.keep_zeros(ray, primitive);
  }
  [[nodiscard]] bool unlimited(std::uint32_t ray) const {
    return options_.sides == Sides::Both && (!masked_ || sight_of_ray(ray).unlimited());
  }
  [[nodiscard]] space::TransformedRay transformed(std::uint32_t ray) const {
    return geometries_.space().transform(predicate::to_double(rays_[ray_of_[ray]], options_.range));
  }

  /// For the resolver.
  [[nodiscard]] const Geometries<Real>& geometries() const { return geometries_; }
  [[nodiscard]] std::uint32_t mask(std::uint32_t ray) const {
    return options_.masks.empty() ? options_.mask : options_.masks[first_ + ray_of_[ray]];
  }
  [[nodiscard]] const Ray<Real>& ray(std::uint32_t number) const { return rays_[ray_of_[number]]; }
  [[nodiscard]] Range range() const { return options_.range; }
  [[nodiscard]] const kernels::Kernel& kernel() const { return kernel_; }
  [[nodiscard]] predicate::LadderCounts& counts() { return counts_; }
  RayLadder<Real> ladder(std::uint32_t ray) {
    finished_.asked[ray / 64] |= std::uint64_t{1} << (ray % 64);
    return {geometries_, predicate::to_double(rays_[ray_of_[ray]], options_.range),
            sight_of_ray(ray), counts_, StopPoll(options_.work.stop)};
  }

  /// A hit for each ray given to start(): the numbers and names of its winner, or a miss. Returns
  /// how many winners there are.
  std::uint32_t finish(std::span<const kernels::Candidate> winners, Hit<Real>* hits) {
    std::uint32_t found = finished_.found;
    geometries_.prefetch(winners.first(size_));
    if (size_ != rays_.size()) std::fill_n(hits, rays_.size(), Hit<Real>{});
    for (std::uint32_t word = 0; word * 64 < size_; ++word) {
      const std::uint64_t all = ~std::uint64_t{0} >> (64 - std::min(64U, size_ - word * 64));
      for (std::uint64_t rest = all & ~finished_.rays[word]; rest != 0; rest &= rest - 1) {
        const std::uint32_t i = word * 64 + static_cast<std::uint32_t>(std::countr_zero(rest));
        if (finish_one(i, winners[i], hits[ray_of_[i]])) ++found;
      }
      if (geometries_.meshes().size() == 1) continue;
      for (std::uint64_t rest = finished_.rays[word]; rest != 0; rest &= rest - 1) {
        set_names(hits[word * 64 + static_cast<std::uint32_t>(std::countr_zero(rest))]);
      }
    }
    round();
    return found;
  }

  /// `hits`: where the kernel may write what it finishes of the closest hits, if anywhere.
  [[nodiscard]] kernels::RayBlock block(Hit<Real>* hits) {
    kernels::RayBlock block{filter_rays_.data(), skips_.data(), size_};
    block.next = reinterpret_cast<const std::byte*>(rays_.data() + rays_.size());
    block.ray_size = sizeof(Ray<Real>);
    block.schedule = &schedule_;
    block.sides = options_.sides;
    if (masked_) block.masks = masks_.data();
    if constexpr (std::is_same_v<Real, float>) {
      if (raw_) {
        block.raw = rays_.data();
        block.scale = geometries_.space().float_scale();
        finished_.hits = hits;
        if (hits != nullptr && geometries_.copies_usable()) block.finished = &finished_;
      }
    } else if (raw_) {
      block.raw_doubles = rays_.data();
      block.map = &geometries_.affine_map();
    }
    return block;
  }
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] std::uint32_t placed_exactly() const { return placed_exactly_; }
  /// Which of the rays given to start() the block's ray is.
  [[nodiscard]] std::uint32_t ray_of(std::uint32_t ray) const { return ray_of_[ray]; }

 private:
  // False if it is a miss. The numbers may have to wait for round().
  bool finish_one(std::uint32_t ray, const kernels::Candidate& winner, Hit<Real>& hit) {
    if (winner.primitive == kNone) {
      hit = {};
      return false;
    }
    hit.triangle = winner.primitive;
    set_names(hit);
    const predicate::TriangleD triangle = geometries_.triangle(winner);
    if (const std::uint8_t zeros = resolver_.zeros(ray, winner); zeros != 0) {
      const auto line = predicate::to_double(rays_[ray_of_[ray]], options_.range);
      set_numbers(round_one<Real>(kernel_, line, triangle, zeros, counts_), hit);
    } else {
      rounding_.add(rays_[ray_of_[ray]], triangle, &hit);
      if (rounding_.full()) round();
    }
    return true;
  }
  // From the number over all geometries, which stands in for that of the triangle.
  void set_names(Hit<Real>& hit) const {
    if (hit.triangle == kNone) return;
    const TriangleRef ref = geometries_.ref(hit.triangle);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
  }

  // Whether the kernel can bring all of them to filter space by itself. They are valid then.
  [[nodiscard]] bool taken_raw(std::span<const Ray<Real>> rays) const {
    if constexpr (std::is_same_v<Real, float>) {
      return geometries_.only_scaled() &&
             kernel_.rays_within(kernels::scaled_limits(geometries_.space().float_scale()),
                                 rays.data(), rays.size());
    } else {
      const space::AffineMap& map = geometries_.affine_map();
      return map.usable && kernel_.rays_mapped(map, rays.data(), rays.size());
    }
  }

  // Transforms the rays, most of them in lanes, the others one by one; leaves out those that miss
  // the scene's box. False if one is not valid: lanes take none such.
  bool transform_rays() {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::size_t count =
          transform_in_lanes(kernel_, geometries_, rays_.subspan(i), &filter_rays_[size_]);
      std::iota(&ray_of_[size_], &ray_of_[size_] + count, static_cast<std::uint32_t>(i));
      size_ += static_cast<std::uint32_t>(count);
      i += count;
      if (i == rays_.size()) break;
      if (!is_valid(rays_[i])) return false;
      const Transformed ray =
          transform(kernel_, geometries_, rays_[i], options_.range, filter_rays_[size_]);
      placed_exactly_ += ray.exactly ? 1 : 0;
      if (ray.misses) continue;
      ray_of_[size_++] = static_cast<std::uint32_t>(i);
    }
    if (options_.sides == Sides::Both && !masked_) return true;
    for (std::uint32_t i = 0; i < size_; ++i) {
      filter_rays_[i].sides = options_.sides;
      filter_rays_[i].masked = masked_;
    }
    return true;
  }

  [[nodiscard]] Sight sight_of_ray(std::uint32_t ray) const {
    return sight_of(geometries_, options_, first_ + ray_of_[ray]);
  }

  [[nodiscard]] bool all_seen() const {
    const auto sees_all = [&](std::uint32_t mask) { return geometries_.all_seen(mask); };
    if (options_.masks.empty()) return sees_all(options_.mask);
    const auto masks = options_.masks.subspan(first_, rays_.size());
    return std::all_of(masks.begin(), masks.end(), sees_all);
  }

  void round() {
    rounding_.round(kernel_, [this](Hit<Real>* hit, const RoundedHit<Real>& rounded) {
      set_rounded(rounded, kernel_, counts_, *hit);
    });
  }

  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  const BatchOptions& options_;
  predicate::LadderCounts& counts_;
  const bool may_be_raw_;
  kernels::PacketSchedule& schedule_;
  std::span<const Ray<Real>> rays_;
  std::size_t first_ = 0;  // their index in the batch
  bool masked_ = false;    // some do not see every geometry
  std::uint32_t size_ = 0;
  bool raw_ = false;  // the kernel transforms them: they are not in filter_rays_
  std::uint32_t placed_exactly_ = 0;
  kernels::FinishedHits finished_;
  HitRounding<Real> rounding_;
  LadderResolver<Real, BlockQuery, kernels::kBlockSize> resolver_;
  std::array<space::FilterRay, kernels::kBlockSize> filter_rays_;
  std::array<std::uint32_t, kernels::kBlockSize> skips_, masks_, ray_of_;
};

}  // namespace pierce::scene
