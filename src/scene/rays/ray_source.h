// SPDX-License-Identifier: Apache-2.0
//
// The rays of a batch, wherever the caller has them: in place if they lie as an array of Ray does,
// else gathered a tile at a time.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

#include "kernels/kernel.h"
#include "pierce/arrays.h"
#include "scene/strided.h"
#include "support/room.h"

namespace pierce::scene {

template <class Real>
class RaySource {
 public:
  /// Room for the rays of a block.
  using Tile = Room<Ray<Real>, kernels::kBlockSize>;

  explicit RaySource(std::span<const Ray<Real>> rays) : size_(rays.size()), rays_(rays.data()) {}
  /// Throws Error (SizeMismatch, InvalidArgument) if the arrays do not fit together.
  explicit RaySource(const RayArrays<Real>& arrays)
      : origins_(arrays.origins),
        directions_(arrays.directions),
        t_min_(arrays.t_min),
        t_max_(arrays.t_max) {
    BatchSize size("ray");
    size.need(arrays.origins, "origins");
    size.need(arrays.directions, "directions");
    size.may_have(arrays.t_min, "t_min");
    size.may_have(arrays.t_max, "t_max");
    size_ = size.get();
    if (lie_as_rays(arrays)) rays_ = reinterpret_cast<const Ray<Real>*>(arrays.origins.data);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Ray<Real> operator[](std::size_t i) const {
    if (rays_ != nullptr) return rays_[i];
    Ray<Real> ray;
    gather(i, {&ray, 1});
    return ray;
  }
  /// The rays first ... first + size - 1, at most a tile of them; good until the tile is used
  /// again.
  [[nodiscard]] std::span<const Ray<Real>> get(std::size_t first, std::size_t size,
                                               Tile& tile) const {
    if (rays_ != nullptr) return {rays_ + first, size};
    gather(first, tile.first(size));
    return tile.first(size);
  }

  /// Tells the block where the rays after it begin, which it prefetches meanwhile.
  void announce(std::size_t next, kernels::RayBlock& block) const {
    const bool near = origins_.stride() > 0 && origins_.stride() <= 64;
    block.next =
        rays_ != nullptr ? reinterpret_cast<const std::byte*>(rays_ + next) : origins_.row(next);
    block.ray_size = rays_ != nullptr ? sizeof(Ray<Real>)
                     : near           ? static_cast<std::size_t>(origins_.stride())
                                      : 0;
  }

  /// Calls `visit(first, rays)` for all of them, tile by tile.
  template <class Visit>
  void for_tiles(const Visit& visit) const {
    Tile tile;
    for (std::size_t first = 0; first < size_; first += kernels::kBlockSize) {
      visit(first, get(first, std::min<std::size_t>(kernels::kBlockSize, size_ - first), tile));
    }
  }

 private:
  static bool lie_as_rays(const RayArrays<Real>& arrays) {
    const auto at = [&](const Rows<const Real>& rows, std::size_t offset) {
      return rows.data == arrays.origins.data + offset && rows.stride == sizeof(Ray<Real>) &&
             rows.step == sizeof(Real) && rows.count == arrays.origins.count;
    };
    static_assert(sizeof(Ray<Real>) == 8 * sizeof(Real));
    return !arrays.origins.empty() && at(arrays.origins, 0) && at(arrays.directions, 3) &&
           at(arrays.t_min, 6) && at(arrays.t_max, 7) && is_aligned(arrays.origins.data);
  }

  void gather(std::size_t first, std::span<Ray<Real>> out) const {
    const std::size_t size = out.size();
    Ray<Real>* rays = out.data();
    constexpr std::size_t kRay = sizeof(Ray<Real>);
    if (directions_.follows(origins_)) {
      origins_.template read<6>(first, size, &rays->origin.x, kRay);
    } else {
      origins_.template read<3>(first, size, &rays->origin.x, kRay);
      directions_.template read<3>(first, size, &rays->direction.x, kRay);
      send_for_directions(first + size);
    }
    if (t_min_.given()) {
      t_min_.template read<1>(first, size, &rays->t_min, kRay);
    } else {
      for (Ray<Real>& ray : out) ray.t_min = 0;
    }
    if (t_max_.given()) {
      t_max_.template read<1>(first, size, &rays->t_max, kRay);
    } else {
      for (Ray<Real>& ray : out) ray.t_max = kInfinity<Real>;
    }
  }

  // Those of the next block, of which the block announces only the origins.
  void send_for_directions(std::size_t next) const {
    const std::ptrdiff_t stride = directions_.stride();
    if (stride <= 0 || stride > 64 || next + kernels::kBlockSize > size_) return;
    const std::byte* from = directions_.row(next);
    const std::ptrdiff_t bytes = stride * static_cast<std::ptrdiff_t>(kernels::kBlockSize);
    for (std::ptrdiff_t i = 0; i < bytes; i += 64) __builtin_prefetch(from + i);
  }

  std::size_t size_ = 0;
  const Ray<Real>* rays_ = nullptr;
  InputRows<Real> origins_, directions_, t_min_, t_max_;
};

}  // namespace pierce::scene
