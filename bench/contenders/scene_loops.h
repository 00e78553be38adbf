// SPDX-License-Identifier: Apache-2.0
//
// The timed part of pierce's own contenders: a Scene asked as its users ask it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contenders/parallel.h"
#include "pierce/scene.h"

namespace pierce::bench {

/// Rays, and room for what a scene says about them.
template <class Real>
struct Asked {
  std::span<const Ray<Real>> rays;
  std::vector<Hit<Real>> hits;
  std::vector<std::uint8_t> any;

  /// For the closest hits, or for any.
  void start(std::span<const Ray<Real>> of, bool closest) {
    rays = of;
    hits.assign(closest ? rays.size() : 0, {});
    any.assign(closest ? 0 : rays.size(), 0);
  }
  [[nodiscard]] bool closest() const { return any.empty(); }
};

template <class Real>
void ask_one_by_one(const Scene<Real>& scene, unsigned threads, Asked<Real>& asked) {
  const Ray<Real>* const rays = asked.rays.data();
  if (asked.closest()) {
    Hit<Real>* const hits = asked.hits.data();
    in_chunks(asked.rays.size(), threads, [=, &scene](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto hit = scene.closest_hit(rays[i]);
        hits[i] = hit ? *hit : Hit<Real>{};
      }
    });
  } else {
    std::uint8_t* const any = asked.any.data();
    in_chunks(asked.rays.size(), threads, [=, &scene](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) any[i] = scene.any_hit(rays[i]) ? 1 : 0;
    });
  }
}

/// In batches of at most `size` rays.
template <class Real>
void ask_together(const Scene<Real>& scene, const BatchOptions& options, std::size_t size,
                  Asked<Real>& asked) {
  for (std::size_t first = 0; first < asked.rays.size(); first += size) {
    const std::size_t count = std::min(size, asked.rays.size() - first);
    const auto rays = asked.rays.subspan(first, count);
    if (asked.closest()) {
      scene.closest_hits(rays, std::span(asked.hits).subspan(first, count), options);
    } else {
      scene.any_hits(rays, std::span(asked.any).subspan(first, count), options);
    }
  }
}

}  // namespace pierce::bench
