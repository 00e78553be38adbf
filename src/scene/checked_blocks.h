// SPDX-License-Identifier: Apache-2.0
//
// The rays of a batch looked at before any is cast: all must be valid, and blocks whose rays all
// take the quick road are noted, so that nobody looks at them again.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "bvh/arena.h"
#include "kernels/kernel.h"
#include "scene/geometries.h"
#include "scene/validate_input.h"

namespace pierce::scene {

template <class Real>
class CheckedBlocks {
 public:
  /// Throws Error (InvalidRay) that names the first bad ray and counts them all.
  CheckedBlocks(const kernels::Kernel& kernel, const Geometries<Real>& geometries,
                std::span<const Ray<Real>> rays, unsigned threads)
      : kernel_(kernel), geometries_(geometries), rays_(rays) {
    quick_.resize((rays.size() + kernels::kBlockSize - 1) / kernels::kBlockSize);
    std::atomic<bool> all_valid = true;
    const auto check = [&](std::size_t begin, std::size_t end) {
      for (std::size_t block = begin; block < end; ++block) {
        if (!check_block(block)) all_valid = false;
      }
    };
    if (quick_.size() <= kBlocksPerTask) {
      check(0, quick_.size());
    } else {
      arena_for(threads).execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, quick_.size(), kBlocksPerTask),
            [&](const tbb::blocked_range<std::size_t>& r) { check(r.begin(), r.end()); });
      });
    }
    if (!all_valid) validate_rays(rays);
  }

  [[nodiscard]] std::size_t size() const { return quick_.size(); }
  /// Whether a kernel can bring all rays of the block to filter space by itself.
  [[nodiscard]] bool quick(std::size_t block) const { return quick_[block] != 0; }

 private:
  static constexpr std::size_t kBlocksPerTask = 64;

  // False if it may hold a ray that is not valid.
  bool check_block(std::size_t block) {
    const std::size_t first = block * kernels::kBlockSize;
    const std::size_t count = std::min<std::size_t>(kernels::kBlockSize, rays_.size() - first);
    const Ray<Real>* rays = &rays_[first];
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.only_scaled()) {
        const auto limits = kernels::quick_limits(geometries_.space().float_scale());
        quick_[block] = kernel_.rays_within(limits, rays, count) ? 1 : 0;
        if (quick_[block] != 0) return true;
      }
    }
    return kernel_.rays_within(kernels::kValidRay<Real>, rays, count);
  }

  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  std::span<const Ray<Real>> rays_;
  std::vector<std::uint8_t> quick_;
};

}  // namespace pierce::scene
