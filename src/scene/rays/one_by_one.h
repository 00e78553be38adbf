// SPDX-License-Identifier: Apache-2.0
//
// Batches whose rays go one by one: those of the queries about all hits, and those that are asked
// about each hit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "scene/rays/counted_hits.h"
#include "scene/rays/ray_source.h"
#include "scene/validate_input.h"
#include "support/for_chunks.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// Of the rays begin ... end - 1, a tile of results at a time: `fill(first, results)` makes them,
/// `write(first, results)` takes them.
template <class Result, class Fill, class Write>
void for_result_tiles(std::size_t begin, std::size_t end, const Fill& fill, const Write& write) {
  std::array<Result, kernels::kBlockSize> tile;
  for (std::size_t first = begin; first < end; first += tile.size()) {
    const std::span results = std::span(tile).first(std::min(tile.size(), end - first));
    fill(first, results);
    write(first, std::span<const Result>(results));
  }
}

/// Runs a batch: checks it, spreads it over threads, and has `answer(ray, sight, sink, counts)`
/// make each result, which `write(first, results)` takes tile by tile. A thread's `Sink` serves all
/// its rays. Rays that are not valid, and may be, have the default result.
template <class Sink, class Result, class Impl, class Real, class Answer, class Write>
void answer_one_by_one(const Impl& impl, const RaySource<Real>& rays, const BatchOptions& options,
                       const Answer& answer, const Write& write) {
  validate_batch(impl.geometries, rays, options);
  CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    Sink sink(impl.geometries, StopPoll(options.work.stop), counts.ladder);
    const auto fill = [&](std::size_t first, std::span<Result> results) {
      for (std::size_t i = 0; i < results.size(); ++i) {
        const Ray<Real> ray = rays[first + i];
        if (!is_valid(ray)) [[unlikely]] {
          results[i] = {};
          continue;
        }
        const auto asked = asked_of(impl.geometries, ray, options, first + i, counts.ladder);
        results[i] = answer(asked.ray(), asked.sight(), sink, counts);
      }
    };
    for_result_tiles<Result>(begin, end, fill, write);
    sum.add(counts);
  };
  for_chunks(rays.size(), options.work, kRaysPerTask, chunk);
}

/// Of the rays from `first` on of a batch that has been looked at: `answer(hits, counts)` makes a
/// result from a ray's CountedHits, or from nullptr for one that is not valid. `all`: it goes
/// through all of them.
template <class Impl, class Real, class Result, class Counts, class Answer>
void answer_rays(const Impl& impl, const RaySource<Real>& rays, std::size_t first,
                 std::span<Result> results, const BatchOptions& options, bool all, Counts& counts,
                 const Answer& answer) {
  const StopPoll stop(options.work.stop);
  CountedHits<Real> hits(impl, options, stop, counts);
  for (std::size_t i = 0; i < results.size(); ++i) {
    stop.now();
    const Ray<Real> ray = rays[first + i];
    if (!is_valid(ray)) [[unlikely]] {
      results[i] = answer(static_cast<CountedHits<Real>*>(nullptr), counts);
      continue;
    }
    ++counts.rays;
    const auto asked = asked_of(impl.geometries, ray, options, first + i, counts.ladder);
    hits.start(asked, first + i, all);
    results[i] = answer(&hits, counts);
  }
}

/// Runs a batch of these.
template <class Result, class Impl, class Real, class Answer, class Write>
void answer_step_by_step(const Impl& impl, const RaySource<Real>& rays, const BatchOptions& options,
                         bool all, const Answer& answer, const Write& write) {
  validate_batch(impl.geometries, rays, options);
  CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    const auto fill = [&](std::size_t first, std::span<Result> results) {
      answer_rays(impl, rays, first, results, options, all, counts, answer);
    };
    for_result_tiles<Result>(begin, end, fill, write);
    sum.add(counts);
  };
  constexpr std::size_t kGrain = 64;  // what a filter does may take long
  for_chunks(rays.size(), options.work, kGrain, chunk);
}

}  // namespace pierce::scene
