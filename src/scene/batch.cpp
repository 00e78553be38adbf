// SPDX-License-Identifier: Apache-2.0
//
// Batches: many rays on many threads, one order of results, one answer.
#include <algorithm>
#include <array>
#include <vector>

#include "scene/for_chunks.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"

namespace pierce {
namespace {

using Skips = std::span<const std::uint32_t>;

// Calls `packet(first, skips)` for runs of at most kPacketSize rays.
template <class Real, class Packet>
void for_packets(const scene::Geometries<Real>& geometries, const BatchOptions& options,
                 std::size_t begin, std::size_t end, const Packet& packet) {
  std::array<std::uint32_t, kernels::kPacketSize> skips;
  skips.fill(kNone);
  for (std::size_t first = begin; first < end; first += kernels::kPacketSize) {
    const std::size_t size = std::min<std::size_t>(kernels::kPacketSize, end - first);
    if (!options.skip.empty()) {
      for (std::size_t i = 0; i < size; ++i)
        skips[i] = scene::skip_of(geometries, options, first + i);
    }
    packet(first, Skips(skips).first(size));
  }
}

// A batch from door to door: checks it, spreads it over threads, and calls
// `answer(first, skips, query, counts)` for each packet's rays from `first` on.
template <class Real, class Impl, class Answer>
void answer_in_packets(const Impl& impl, std::span<const Ray<Real>> rays, std::size_t results,
                       const BatchOptions& options, const Answer& answer) {
  scene::validate_sizes(rays.size(), results, options);
  scene::validate_rays(rays);
  scene::CountSum<typename Impl::Counts> sum(options.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    scene::PacketQuery<Real> query(*impl.kernel, impl.geometries, counts.ladder);
    for_packets(impl.geometries, options, begin, end, [&](std::size_t first, const Skips& skips) {
      answer(first, skips, query, counts);
    });
    sum.add(counts);
  };
  scene::for_chunks(rays.size(), options, scene::kRaysPerTask, chunk);
}

}  // namespace

template <class Real>
void Scene<Real>::closest_hits(std::span<const Ray<Real>> rays, std::span<Hit<Real>> hits,
                               const BatchOptions& options) const {
  const auto answer = [&](std::size_t first, const Skips& skips, auto& query, auto& counts) {
    impl_->closest(rays.subspan(first, skips.size()), skips, options.range, query, &hits[first],
                   counts);
  };
  answer_in_packets(*impl_, rays, hits.size(), options, answer);
}

template <class Real>
void Scene<Real>::any_hits(std::span<const Ray<Real>> rays, std::span<std::uint8_t> hits,
                           const BatchOptions& options) const {
  const auto answer = [&](std::size_t first, const Skips& skips, auto& query, auto& counts) {
    impl_->any(rays.subspan(first, skips.size()), skips, options.range, query, &hits[first],
               counts);
  };
  answer_in_packets(*impl_, rays, hits.size(), options, answer);
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
