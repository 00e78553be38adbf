// SPDX-License-Identifier: Apache-2.0
//
// Batches: many rays on many threads, one order of results, one answer.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <string>
#include <vector>

#include "scene/scene_impl.h"
#include "scene/validate_input.h"

namespace pierce {
namespace {

constexpr std::size_t kChunk =
    1024;  // rays a task: small enough to balance, large enough to amortise

void validate_sizes(std::size_t rays, std::size_t outputs, const BatchOptions& options) {
  if (rays != outputs) {
    throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(rays) +
                                             " rays but room for " + std::to_string(outputs) +
                                             " results; make the spans equally long");
  }
  if (!options.skip.empty() && options.skip.size() != rays) {
    throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(rays) + " rays but " +
                                             std::to_string(options.skip.size()) +
                                             " triangles to skip; give none, or one a ray");
  }
}

// Runs `work(begin, end)` over chunks of the rays on the wanted number of threads; polls stop and
// reports progress between chunks.
template <class Work>
void for_chunks(std::size_t count, std::size_t grain, const BatchOptions& options,
                const Work& work) {
  std::mutex progress_mutex;
  std::size_t done = 0;
  const auto body = [&](const tbb::blocked_range<std::size_t>& chunk) {
    if (options.stop.stop_requested()) return;
    work(chunk.begin(), chunk.end());
    if (!options.progress) return;
    const std::lock_guard lock(progress_mutex);
    done += chunk.size();
    options.progress(static_cast<double>(done) / static_cast<double>(count));
  };
  const int threads =
      options.threads == 0 ? tbb::task_arena::automatic : static_cast<int>(options.threads);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), body,
                      tbb::simple_partitioner());
  });
  if (options.stop.stop_requested()) throw Error(ErrorCode::Stopped, "stopped by the caller");
}

// Per-chunk counts, added up under a lock when the chunk is done.
template <class Counts>
class CountSum {
 public:
  explicit CountSum(Statistics* statistics) : statistics_(statistics) {}
  [[nodiscard]] Counts start() const {
    Counts counts;
    counts.wanted = statistics_ != nullptr;
    return counts;
  }
  void add(const Counts& counts) {
    if (statistics_ == nullptr) return;
    const std::lock_guard lock(mutex_);
    counts.add_to(*statistics_);
  }

 private:
  Statistics* statistics_;
  std::mutex mutex_;
};

template <class Real>
std::uint32_t skip_of(const scene::Geometries<Real>& geometries, const BatchOptions& options,
                      std::size_t ray) {
  return options.skip.empty() ? kNone : geometries.primitive(options.skip[ray]);
}

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
      for (std::size_t i = 0; i < size; ++i) skips[i] = skip_of(geometries, options, first + i);
    }
    packet(first, Skips(skips).first(size));
  }
}

}  // namespace

template <class Real>
void Scene<Real>::closest_hits(std::span<const Ray<Real>> rays, std::span<Hit<Real>> hits,
                               const BatchOptions& options) const {
  validate_sizes(rays.size(), hits.size(), options);
  scene::validate_rays(rays);
  CountSum<typename Impl::Counts> sum(options.statistics);
  for_chunks(rays.size(), kChunk, options, [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    scene::PacketQuery<Real> query(*impl_->kernel, impl_->geometries, counts.ladder);
    for_packets(impl_->geometries, options, begin, end, [&](std::size_t first, const Skips& skips) {
      impl_->closest(rays.subspan(first, skips.size()), skips, options.range, query, &hits[first],
                     counts);
    });
    sum.add(counts);
  });
}

template <class Real>
void Scene<Real>::any_hits(std::span<const Ray<Real>> rays, std::span<std::uint8_t> hits,
                           const BatchOptions& options) const {
  validate_sizes(rays.size(), hits.size(), options);
  scene::validate_rays(rays);
  CountSum<typename Impl::Counts> sum(options.statistics);
  for_chunks(rays.size(), kChunk, options, [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    scene::PacketQuery<Real> query(*impl_->kernel, impl_->geometries, counts.ladder);
    for_packets(impl_->geometries, options, begin, end, [&](std::size_t first, const Skips& skips) {
      impl_->any(rays.subspan(first, skips.size()), skips, options.range, query, &hits[first],
                 counts);
    });
    sum.add(counts);
  });
}

template <class Real>
HitLists<Real> Scene<Real>::all_hits(std::span<const Ray<Real>> rays,
                                     const BatchOptions& options) const {
  validate_sizes(rays.size(), rays.size(), options);
  scene::validate_rays(rays);
  CountSum<typename Impl::Counts> sum(options.statistics);
  std::vector<std::vector<Hit<Real>>> chunks((rays.size() + kChunk - 1) / kChunk);
  HitLists<Real> lists;
  lists.offsets.assign(rays.size() + 1, 0);
  for_chunks(chunks.size(), 1, options, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      auto counts = sum.start();
      scene::HitCollector<Real> collector(impl_->geometries, counts.ladder);
      const std::size_t last = std::min(rays.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < last; ++i) {
        const std::uint32_t skip = skip_of(impl_->geometries, options, i);
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
