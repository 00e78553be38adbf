// SPDX-License-Identifier: Apache-2.0
//
// Batches: many rays on many threads, one order of results, one answer.
#include <algorithm>
#include <array>
#include <vector>

#include "scene/checked_blocks.h"
#include "scene/for_chunks.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"

namespace pierce {
namespace {

// A batch from door to door: checks it, spreads it over threads, and calls
// `answer(first, query, counts)` for each block's rays from `first` on.
template <class Real, class Impl, class Answer>
void answer_in_blocks(const Impl& impl, std::span<const Ray<Real>> rays, std::size_t results,
                      const BatchOptions& options, const Answer& answer) {
  scene::validate_sizes(rays.size(), results, options);
  const scene::CheckedBlocks<Real> blocks(*impl.kernel, impl.geometries, rays, options.threads);
  scene::CountSum<typename Impl::Counts> sum(options.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    scene::BlockQuery<Real> query(*impl.kernel, impl.geometries, counts.ladder);
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t first = block * kernels::kBlockSize;
      const std::size_t size = std::min<std::size_t>(kernels::kBlockSize, rays.size() - first);
      query.start(rays.subspan(first, size), blocks.quick(block),
                  options.skip.empty() ? options.skip : options.skip.subspan(first, size),
                  options.range);
      counts.rays += size;
      counts.placed_exactly += query.placed_exactly();
      answer(first, size, query, counts);
    }
    sum.add(counts);
  };
  scene::for_chunks(blocks.size(), options, scene::kRaysPerTask / kernels::kBlockSize, chunk);
}

}  // namespace

template <class Real>
void Scene<Real>::closest_hits(std::span<const Ray<Real>> rays, std::span<Hit<Real>> hits,
                               const BatchOptions& options) const {
  answer_in_blocks(*impl_, rays, hits.size(), options,
                   [&](std::size_t first, std::size_t, auto& query, auto& counts) {
                     impl_->closest(query, &hits[first], counts);
                   });
}

template <class Real>
void Scene<Real>::any_hits(std::span<const Ray<Real>> rays, std::span<std::uint8_t> hits,
                           const BatchOptions& options) const {
  answer_in_blocks(*impl_, rays, hits.size(), options,
                   [&](std::size_t first, std::size_t size, auto& query, auto& counts) {
                     std::ranges::fill(hits.subspan(first, size), std::uint8_t{0});
                     impl_->any(query, &hits[first], counts);
                   });
}

template <class Real>
HitLists<Real> Scene<Real>::all_hits(std::span<const Ray<Real>> rays,
                                     const BatchOptions& options) const {
  scene::validate_sizes(rays.size(), rays.size(), options);
  scene::validate_rays(rays);
  scene::CountSum<typename Impl::Counts> sum(options.statistics);
  std::vector<std::vector<Hit<Real>>> chunks((rays.size() + scene::kRaysPerTask - 1) /
                                             scene::kRaysPerTask);
  HitLists<Real> lists;
  lists.offsets.assign(rays.size() + 1, 0);
  scene::for_chunks(chunks.size(), options, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      auto counts = sum.start();
      scene::HitCollector<Real> collector(impl_->geometries, counts.ladder);
      const std::size_t last = std::min(rays.size(), (chunk + 1) * scene::kRaysPerTask);
      for (std::size_t i = chunk * scene::kRaysPerTask; i < last; ++i) {
        const std::uint32_t skip = scene::skip_of(impl_->geometries, options, i);
        const std::size_t before = chunks[chunk].size();
        impl_->all(rays[i], options.range, skip, collector, chunks[chunk], counts);
        lists.offsets[i + 1] = chunks[chunk].size() - before;
      }
      sum.add(counts);
    }
  });
  for (std::size_t i = 0; i < rays.size(); ++i) lists.offsets[i + 1] += lists.offsets[i];
  lists.hits.reserve(lists.offsets.back());
  for (const auto& chunk : chunks) {
    lists.hits.insert(lists.hits.end(), chunk.begin(), chunk.end());
  }
  return lists;
}

template void Scene<float>::closest_hits(std::span<const Ray<float>>, std::span<Hit<float>>,
                                         const BatchOptions&) const;
template void Scene<double>::closest_hits(std::span<const Ray<double>>, std::span<Hit<double>>,
                                          const BatchOptions&) const;
template void Scene<float>::any_hits(std::span<const Ray<float>>, std::span<std::uint8_t>,
                                     const BatchOptions&) const;
template void Scene<double>::any_hits(std::span<const Ray<double>>, std::span<std::uint8_t>,
                                      const BatchOptions&) const;
template HitLists<float> Scene<float>::all_hits(std::span<const Ray<float>>,
                                                const BatchOptions&) const;
template HitLists<double> Scene<double>::all_hits(std::span<const Ray<double>>,
                                                  const BatchOptions&) const;

}  // namespace pierce
