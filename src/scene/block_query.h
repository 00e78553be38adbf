// SPDX-License-Identifier: Apache-2.0
//
// A block of rays of a batch on their way through a scene.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>

#include "kernels/kernel.h"
#include "scene/hit_rounding.h"
#include "scene/ladder_referee.h"
#include "scene/road.h"

namespace pierce::scene {

/// The rays that enter filter space, with a referee for each that needs one.
template <class Real>
class BlockQuery final : public kernels::Referees {
 public:
  BlockQuery(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
             predicate::LadderCounts& counts)
      : kernel_(kernel), geometries_(geometries), counts_(counts) {}

  /// Starts on other rays, at most kBlockSize; `skips`: none, or a triangle a ray.
  void start(std::span<const Ray<Real>> rays, std::span<const TriangleRef> skips, Range range) {
    rays_ = rays;
    range_ = range;
    size_ = 0;
    placed_exactly_ = 0;
    asked_.clear();
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const Road<Real> road(kernel_, geometries_, rays[i], range);
      placed_exactly_ += road.exactly() ? 1 : 0;
      if (road.misses()) continue;
      filter_rays_[size_] = road.filter_ray();
      skips_[size_] = skips.empty() ? kNone : geometries_.primitive(skips[i]);
      ray_of_[size_] = i;
      asked_of_[size_] = kNobody;
      ++size_;
    }
  }

  kernels::Referee& of(std::uint32_t ray) override {
    if (asked_of_[ray] == kNobody) {
      asked_of_[ray] = static_cast<std::uint16_t>(asked_.size());
      asked_.emplace_back(*this, rays_[ray_of_[ray]]);
    }
    return asked_[asked_of_[ray]].referee;
  }

  /// The numbers and names of the winners that there are, to where their rays stand; returns how
  /// many there are.
  std::uint32_t finish(std::span<const kernels::Candidate> winners, Hit<Real>* hits) {
    std::uint32_t found = 0;
    for (std::uint32_t i = 0; i < size_; ++i) {
      const kernels::Candidate& winner = winners[i];
      if (winner.primitive == kNone) continue;
      ++found;
      Hit<Real>& hit = hits[ray_of_[i]];
      const TriangleRef ref = geometries_.ref(winner.primitive);
      hit.geometry = ref.geometry;
      hit.triangle = ref.triangle;
      if (asked_of_[i] != kNobody) {
        set_numbers(asked_[asked_of_[i]].referee.rounded(winner, kernel_), hit);
      } else {
        rounding_.add(rays_[ray_of_[i]], geometries_.triangle(winner), hit);
        if (rounding_.full()) round();
      }
    }
    round();
    return found;
  }

  [[nodiscard]] kernels::RayBlock block() const {
    return {filter_rays_.data(), skips_.data(), size_};
  }
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] std::uint32_t placed_exactly() const { return placed_exactly_; }
  /// Which of the rays given to start() the block's ray is.
  [[nodiscard]] std::uint32_t ray_of(std::uint32_t ray) const { return ray_of_[ray]; }

 private:
  static constexpr std::uint16_t kNobody = 0xffff;

  void round() { rounding_.round(kernel_, counts_); }

  // A ray that a kernel could not tell everything about.
  struct Asked {
    Asked(BlockQuery& query, const Ray<Real>& ray)
        : road(query.kernel_, query.geometries_, ray, query.range_),
          referee(query.geometries_, road, query.counts_) {}
    Road<Real> road;
    LadderReferee<Real> referee;
  };

  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  predicate::LadderCounts& counts_;
  std::span<const Ray<Real>> rays_;
  Range range_ = Range::Closed;
  std::uint32_t size_ = 0;
  std::uint32_t placed_exactly_ = 0;
  HitRounding<Real> rounding_;
  std::deque<Asked> asked_;
  std::array<std::uint16_t, kernels::kBlockSize> asked_of_;  // place in asked_, or kNobody
  std::array<kernels::FilterRay, kernels::kBlockSize> filter_rays_;
  std::array<std::uint32_t, kernels::kBlockSize> skips_, ray_of_;
};

}  // namespace pierce::scene
