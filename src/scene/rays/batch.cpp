// SPDX-License-Identifier: Apache-2.0
//
// Batches for the closest and for any hit: many rays on many threads, one order of results, one
// answer.
#include <algorithm>
#include <array>
#include <atomic>

#include "scene/rays/block_query.h"
#include "scene/rays/hit_tiles.h"
#include "scene/rays/one_by_one.h"
#include "scene/rays/ray_source.h"
#include "scene/rays/two_level_block.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"
#include "support/room.h"

namespace pierce {
namespace {

// A batch from door to door: spreads it over threads, checks it, and calls
// `answer(query, first, size, counts)` for each block: the rays first ... first + size - 1. Throws
// Error (InvalidRay) after some blocks were answered: rays are looked at when they are at hand. A
// block with bad rays that count as misses is answered ray by ray, by `one_by_one(first, size,
// counts)`.
template <class Real, class Impl, class Answer, class OneByOne>
void answer_in_blocks(const Impl& impl, const scene::RaySource<Real>& rays,
                      const BatchOptions& options, const Answer& answer,
                      const OneByOne& one_by_one) {
  scene::validate_options(impl.geometries, rays.size(), options);
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  std::atomic<bool> all_valid = true;
  kernels::PacketSchedule schedule;
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    scene::BlockQuery<Real> query(*impl.kernel, impl.geometries, options, impl.two_level == nullptr,
                                  schedule, counts.ladder);
    const scene::StopPoll stop(options.work.stop);
    typename scene::RaySource<Real>::Tile tile;
    for (std::size_t block = begin; block < end && all_valid; ++block) {
      const std::size_t first = block * kernels::kBlockSize;
      const std::size_t size = std::min<std::size_t>(kernels::kBlockSize, rays.size() - first);
      stop.now();
      if (!query.start(rays.get(first, size, tile), first)) {
        if (options.invalid == InvalidRays::Throw) {
          all_valid = false;
          return;
        }
        one_by_one(first, size, counts);
        continue;
      }
      counts.rays += size;
      counts.placed_exactly += query.placed_exactly();
      answer(query, first, size, counts);
    }
    sum.add(counts);
  };
  const std::size_t blocks = (rays.size() + kernels::kBlockSize - 1) / kernels::kBlockSize;
  scene::for_chunks(blocks, options.work, scene::kRaysPerTask / kernels::kBlockSize, chunk);
  if (!all_valid) scene::validate_rays(rays, options.work.stop);
}

// So few rays are done one by one before a block is ready for them.
constexpr std::size_t kFewRays = 8;

// Few rays, of which nobody wants to know more than the answers.
bool are_few(std::size_t rays, const BatchOptions& options) {
  const WorkOptions& work = options.work;
  return rays <= kFewRays && work.statistics == nullptr && work.stop == nullptr && !work.progress &&
         !scene::goes_step_by_step(options);
}

// Calls `answer(i, ray, sight)` for each of few rays that is valid, in whatever they lie.
template <class Real, class Rays, class Answer>
void answer_few(const scene::Geometries<Real>& geometries, const Rays& rays,
                const BatchOptions& options, const Answer& answer) {
  scene::validate_options(geometries, rays.size(), options);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray<Real>& ray = rays[i];
    if (scene::is_valid(ray)) [[likely]] {
      answer(i, ray, scene::sight_of(geometries, options, i));
    } else if (options.invalid == InvalidRays::Throw) {
      scene::validate_rays(scene::RaySource<Real>(rays), nullptr);
    }
  }
}

}  // namespace

template <class Real>
void Scene<Real>::Impl::closest_hits(const scene::RaySource<Real>& rays,
                                     const scene::HitTiles<Real>& hits,
                                     const BatchOptions& options) const {
  using Blocks = scene::TwoLevelBlock<Real, scene::BlockQuery<Real>>;
  const auto first_of = [](scene::CountedHits<Real>* counted, auto& counts) {
    if (counted == nullptr || !counted->next()) return Hit<Real>{};
    ++counts.hits;
    return counted->hit();
  };
  const auto write = [&](std::size_t first, std::span<const Hit<Real>> results) {
    hits.write(first, results);
    if (!hits.places().wanted()) return;
    for (std::size_t i = 0; i < results.size(); ++i) {
      hits.places().write(first + i, rays[first + i], results[i], geometries);
    }
  };
  if (scene::goes_step_by_step(options)) {
    scene::answer_step_by_step<Hit<Real>>(*this, rays, options, false, first_of, write);
    return;
  }
  if (are_few(rays.size(), options)) {
    std::array<Hit<Real>, kFewRays> found{};
    answer_few(geometries, rays, options, [&](std::size_t i, const auto& ray, const auto& sight) {
      if (!closest(ray, options.range, sight, found[i])) found[i] = {};
    });
    return write(0, std::span(found).first(rays.size()));
  }
  const auto one_by_one = [&](std::size_t first, std::size_t size, auto& counts) {
    typename scene::HitTiles<Real>::Tile tile;
    const std::span results(hits.room(first, tile), size);
    scene::answer_rays(*this, rays, first, results, options, false, counts, first_of);
    write(first, results);
  };
  const auto answer = [&](scene::BlockQuery<Real>& query, std::size_t first, std::size_t size,
                          auto& counts) {
    typename scene::HitTiles<Real>::Tile tile;
    Hit<Real>* room = hits.room(first, tile);
    Room<kernels::Candidate, kernels::kBlockSize> room_of_winners;
    const std::span winners = room_of_winners.first(size);
    std::fill(winners.begin(), winners.end(), kernels::Candidate{});
    kernels::RayBlock block = query.block(room);
    rays.announce(first + size, block);
    if (two_level == nullptr) [[likely]] {
      kernel->closest_block(tree, block, query.resolver(), winners.data(), counts.kernel_counts());
    } else {
      Blocks(*kernel, *two_level, query).closest(block, winners.data(), counts.kernel_counts());
    }
    counts.hits += query.finish(winners, room);
    write(first, {room, size});
  };
  answer_in_blocks(*this, rays, options, answer, one_by_one);
}

template <class Real>
void Scene<Real>::Impl::any_hits(const scene::RaySource<Real>& rays,
                                 const scene::OutputRows<std::uint8_t>& hits,
                                 const BatchOptions& options) const {
  using Blocks = scene::TwoLevelBlock<Real, scene::BlockQuery<Real>>;
  const auto is_any = [](scene::CountedHits<Real>* counted, auto& counts) {
    const std::uint8_t found = counted != nullptr && counted->next() ? 1 : 0;
    counts.hits += found;
    return found;
  };
  const auto write = [&](std::size_t first, std::span<const std::uint8_t> results) {
    hits.write(first, results, [](std::uint8_t hit) { return hit; });
  };
  if (scene::goes_step_by_step(options)) {
    scene::answer_step_by_step<std::uint8_t>(*this, rays, options, false, is_any, write);
    return;
  }
  if (are_few(rays.size(), options)) {
    std::array<std::uint8_t, kFewRays> found{};
    answer_few(geometries, rays, options, [&](std::size_t i, const auto& ray, const auto& sight) {
      found[i] = any(ray, options.range, sight) ? 1 : 0;
    });
    return write(0, std::span(found).first(rays.size()));
  }
  const auto one_by_one = [&](std::size_t first, std::size_t size, auto& counts) {
    std::array<std::uint8_t, kernels::kBlockSize> tile;
    const std::span results(tile.data(), size);
    scene::answer_rays(*this, rays, first, results, options, false, counts, is_any);
    write(first, results);
  };
  const auto answer = [&](scene::BlockQuery<Real>& query, std::size_t first, std::size_t size,
                          auto& counts) {
    std::array<std::uint8_t, kernels::kBlockSize> tile, found;
    std::uint8_t* in_place = hits.in_place(first);
    const std::span own(in_place != nullptr ? in_place : tile.data(), size);
    const bool as_they_are = query.size() == size;  // no ray is left out
    kernels::RayBlock block = query.block(nullptr);
    rays.announce(first + size, block);
    std::uint8_t* const out = as_they_are ? own.data() : found.data();
    if (two_level == nullptr) [[likely]] {
      kernel->any_block(tree, block, query.resolver(), out, counts.kernel_counts());
    } else {
      Blocks(*kernel, *two_level, query).any(block, out, counts.kernel_counts());
    }
    if (!as_they_are) {
      std::fill(own.begin(), own.end(), std::uint8_t{0});
      for (std::uint32_t i = 0; i < query.size(); ++i) own[query.ray_of(i)] = found[i];
    }
    counts.hits += static_cast<std::uint64_t>(std::count(own.begin(), own.end(), std::uint8_t{1}));
    if (in_place != nullptr) return;
    write(first, own);
  };
  answer_in_blocks(*this, rays, options, answer, one_by_one);
}

template <class Real>
void Scene<Real>::closest_hits(const RayArrays<Real>& rays, const HitArrays<Real>& hits,
                               const BatchOptions& options) const {
  const FloatEnvironment environment;
  const scene::RaySource<Real> source(rays);
  impl_->closest_hits(source, {hits, source.size()}, options);
}
template <class Real>
void Scene<Real>::closest_hits(std::span<const Ray<Real>> rays, std::span<Hit<Real>> hits,
                               const BatchOptions& options) const {
  const FloatEnvironment environment;
  scene::validate_outputs("ray", rays.size(), hits.size());
  if (are_few(rays.size(), options)) {
    const auto set = [&](std::size_t i, const Ray<Real>& ray, const scene::Sight& sight) {
      if (!impl_->closest(ray, options.range, sight, hits[i])) hits[i] = {};
    };
    std::fill(hits.begin(), hits.end(), Hit<Real>{});
    return answer_few(impl_->geometries, rays, options, set);
  }
  impl_->closest_hits(scene::RaySource<Real>(rays), {HitArrays<Real>{.hits = hits}, rays.size()},
                      options);
}

template <class Real>
void Scene<Real>::any_hits(const RayArrays<Real>& rays, const Rows<std::uint8_t>& hits,
                           const BatchOptions& options) const {
  const FloatEnvironment environment;
  const scene::RaySource<Real> source(rays);
  scene::validate_outputs("ray", source.size(), hits.count);
  impl_->any_hits(source, {hits, source.size(), "ray", "hits"}, options);
}
template <class Real>
void Scene<Real>::any_hits(std::span<const Ray<Real>> rays, std::span<std::uint8_t> hits,
                           const BatchOptions& options) const {
  if (rays.size() == hits.size() && are_few(rays.size(), options)) {
    const FloatEnvironment environment;
    const auto set = [&](std::size_t i, const Ray<Real>& ray, const scene::Sight& sight) {
      hits[i] = impl_->any(ray, options.range, sight) ? 1 : 0;
    };
    std::fill(hits.begin(), hits.end(), std::uint8_t{0});
    return answer_few(impl_->geometries, rays, options, set);
  }
  any_hits(RayArrays<Real>::of(rays), rows(hits), options);
}

template void Scene<float>::Impl::closest_hits(const scene::RaySource<float>&,
                                               const scene::HitTiles<float>&,
                                               const BatchOptions&) const;
template void Scene<float>::Impl::any_hits(const scene::RaySource<float>&,
                                           const scene::OutputRows<std::uint8_t>&,
                                           const BatchOptions&) const;
template void Scene<double>::Impl::closest_hits(const scene::RaySource<double>&,
                                                const scene::HitTiles<double>&,
                                                const BatchOptions&) const;
template void Scene<double>::Impl::any_hits(const scene::RaySource<double>&,
                                            const scene::OutputRows<std::uint8_t>&,
                                            const BatchOptions&) const;
template void Scene<float>::closest_hits(const RayArrays<float>&, const HitArrays<float>&,
                                         const BatchOptions&) const;
template void Scene<double>::closest_hits(const RayArrays<double>&, const HitArrays<double>&,
                                          const BatchOptions&) const;
template void Scene<float>::closest_hits(std::span<const Ray<float>>, std::span<Hit<float>>,
                                         const BatchOptions&) const;
template void Scene<double>::closest_hits(std::span<const Ray<double>>, std::span<Hit<double>>,
                                          const BatchOptions&) const;
template void Scene<float>::any_hits(const RayArrays<float>&, const Rows<std::uint8_t>&,
                                     const BatchOptions&) const;
template void Scene<double>::any_hits(const RayArrays<double>&, const Rows<std::uint8_t>&,
                                      const BatchOptions&) const;
template void Scene<float>::any_hits(std::span<const Ray<float>>, std::span<std::uint8_t>,
                                     const BatchOptions&) const;
template void Scene<double>::any_hits(std::span<const Ray<double>>, std::span<std::uint8_t>,
                                      const BatchOptions&) const;

}  // namespace pierce
