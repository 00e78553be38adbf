// SPDX-License-Identifier: Apache-2.0
//
// Batches for the closest and for any hit: many rays on many threads, one order of results, one
// answer.
#include <algorithm>
#include <array>
#include <atomic>

#include "scene/rays/block_query.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

// A batch from door to door: spreads it over threads, checks it, and calls
// `answer(query, first, size, counts)` for each block: the rays first ... first + size - 1. Throws
// Error (InvalidRay) after some blocks were answered: rays are looked at when they are at hand.
template <class Real, class Impl, class Answer>
void answer_in_blocks(const Impl& impl, std::span<const Ray<Real>> rays, std::size_t results,
                      const BatchOptions& options, const Answer& answer) {
  scene::validate_options(impl.geometries, rays.size(), results, options);
  scene::CountSum<typename Impl::Counts> sum(options.statistics);
  std::atomic<bool> all_valid = true;
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    scene::BlockQuery<Real> query(*impl.kernel, impl.geometries, options, counts.ladder);
    const scene::StopPoll stop(options.stop);
    for (std::size_t block = begin; block < end && all_valid; ++block) {
      const std::size_t first = block * kernels::kBlockSize;
      const std::size_t size = std::min<std::size_t>(kernels::kBlockSize, rays.size() - first);
      stop.now();
      if (!query.start(rays.subspan(first, size), first)) {
        all_valid = false;
        return;
      }
      counts.rays += size;
      counts.placed_exactly += query.placed_exactly();
      answer(query, first, size, counts);
    }
    sum.add(counts);
  };
  const std::size_t blocks = (rays.size() + kernels::kBlockSize - 1) / kernels::kBlockSize;
  scene::for_chunks(blocks, options, scene::kRaysPerTask / kernels::kBlockSize, chunk);
  if (!all_valid) scene::validate_rays(rays);
}

}  // namespace

template <class Real>
void Scene<Real>::closest_hits(std::span<const Ray<Real>> rays, std::span<Hit<Real>> hits,
                               const BatchOptions& options) const {
  const FloatEnvironment environment;
  const auto answer = [&](scene::BlockQuery<Real>& query, std::size_t first, std::size_t,
                          auto& counts) {
    std::array<kernels::Candidate, kernels::kBlockSize> winners;
    impl_->kernel->closest_block(impl_->tree, query.block(&hits[first]), query, winners.data(),
                                 counts.kernel_counts());
    counts.hits += query.finish(winners, &hits[first]);
  };
  answer_in_blocks(*impl_, rays, hits.size(), options, answer);
}

template <class Real>
void Scene<Real>::any_hits(std::span<const Ray<Real>> rays, std::span<std::uint8_t> hits,
                           const BatchOptions& options) const {
  const FloatEnvironment environment;
  const auto answer = [&](scene::BlockQuery<Real>& query, std::size_t first, std::size_t size,
                          auto& counts) {
    const auto own = hits.subspan(first, size);
    std::array<std::uint8_t, kernels::kBlockSize> found;
    const bool as_they_are = query.size() == size;  // no ray is left out
    impl_->kernel->any_block(impl_->tree, query.block(nullptr), query,
                             as_they_are ? own.data() : found.data(), counts.kernel_counts());
    if (!as_they_are) {
      std::ranges::fill(own, std::uint8_t{0});
      for (std::uint32_t i = 0; i < query.size(); ++i) own[query.ray_of(i)] = found[i];
    }
    counts.hits += static_cast<std::uint64_t>(std::ranges::count(own, std::uint8_t{1}));
  };
  answer_in_blocks(*impl_, rays, hits.size(), options, answer);
}

template void Scene<float>::closest_hits(std::span<const Ray<float>>, std::span<Hit<float>>,
                                         const BatchOptions&) const;
template void Scene<double>::closest_hits(std::span<const Ray<double>>, std::span<Hit<double>>,
                                          const BatchOptions&) const;
template void Scene<float>::any_hits(std::span<const Ray<float>>, std::span<std::uint8_t>,
                                     const BatchOptions&) const;
template void Scene<double>::any_hits(std::span<const Ray<double>>, std::span<std::uint8_t>,
                                      const BatchOptions&) const;

}  // namespace pierce
