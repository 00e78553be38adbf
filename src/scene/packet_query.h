// SPDX-License-Identifier: Apache-2.0
//
// Up to sixteen rays of a batch on their way through a scene together.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "kernels/kernel.h"
#include "scene/ladder_referee.h"
#include "scene/road.h"

namespace pierce::scene {

/// The rays that enter filter space, with a referee for each that needs one.
template <class Real>
class PacketQuery final : public kernels::Referees {
 public:
  PacketQuery(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
              predicate::LadderCounts& counts)
      : kernel_(kernel), geometries_(geometries), counts_(counts) {}

  /// Starts on other rays, at most kPacketSize; skips: one primitive a ray.
  void start(std::span<const Ray<Real>> rays, std::span<const std::uint32_t> skips, Range range) {
    size_ = 0;
    placed_exactly_ = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      referees_[size_].reset();
      const Road<Real>& road = roads_[size_].emplace(kernel_, geometries_, rays[i], range);
      placed_exactly_ += road.exactly() ? 1 : 0;
      if (road.misses()) continue;
      filter_rays_[size_] = road.filter_ray();
      skips_[size_] = skips[i];
      ray_of_[size_] = i;
      ++size_;
    }
  }

  kernels::Referee& of(std::uint32_t ray) override { return referee(ray); }

  LadderReferee<Real>& referee(std::uint32_t ray) {
    if (!referees_[ray]) referees_[ray].emplace(geometries_, *roads_[ray], counts_);
    return *referees_[ray];
  }

  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] std::uint32_t placed_exactly() const { return placed_exactly_; }
  /// Which of the rays given to start() the packet's ray is.
  [[nodiscard]] std::uint32_t ray_of(std::uint32_t ray) const { return ray_of_[ray]; }
  [[nodiscard]] const kernels::FilterRay* filter_rays() const { return filter_rays_.data(); }
  [[nodiscard]] const std::uint32_t* skips() const { return skips_.data(); }

 private:
  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  predicate::LadderCounts& counts_;
  std::uint32_t size_ = 0;
  std::uint32_t placed_exactly_ = 0;
  std::array<std::optional<Road<Real>>, kernels::kPacketSize> roads_;
  std::array<std::optional<LadderReferee<Real>>, kernels::kPacketSize> referees_;
  std::array<kernels::FilterRay, kernels::kPacketSize> filter_rays_;
  std::array<std::uint32_t, kernels::kPacketSize> skips_, ray_of_;
};

}  // namespace pierce::scene
