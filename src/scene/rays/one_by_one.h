// SPDX-License-Identifier: Apache-2.0
//
// Batches whose rays go one by one: those of the queries about all hits.
#pragma once

#include <cstddef>
#include <span>

#include "scene/rays/counted_hits.h"
#include "scene/validate_input.h"
#include "support/for_chunks.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// A batch from door to door: checks it, spreads it over threads, and has `answer(ray, sight,
/// sink, counts)` make each result. A thread's `Sink` serves all its rays. Rays that are
/// not valid, and may be, have the default result.
template <class Sink, class Impl, class Real, class Result, class Answer>
void answer_one_by_one(const Impl& impl, std::span<const Ray<Real>> rays, std::span<Result> results,
                       const BatchOptions& options, const Answer& answer) {
  validate_batch(impl.geometries, rays, results.size(), options);
  CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    Sink sink(impl.geometries, StopPoll(options.work.stop), counts.ladder);
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_valid(rays[i])) [[unlikely]] {
        results[i] = {};
        continue;
      }
      const auto asked = asked_of(impl.geometries, rays[i], options, i, counts.ladder);
      results[i] = answer(asked.ray(), asked.sight(), sink, counts);
    }
    sum.add(counts);
  };
  for_chunks(rays.size(), options.work, kRaysPerTask, chunk);
}

/// Of the rays first ... last - 1 of a batch that has been looked at: `answer(i, hits, counts)`
/// makes the result of ray i from its CountedHits, or from nullptr for one that is not valid.
/// `all`: it goes through all of them.
template <class Impl, class Real, class Counts, class Answer>
void answer_rays(const Impl& impl, std::span<const Ray<Real>> rays, std::size_t first,
                 std::size_t last, const BatchOptions& options, bool all, Counts& counts,
                 const Answer& answer) {
  const StopPoll stop(options.work.stop);
  CountedHits<Real> hits(impl, options, stop, counts);
  for (std::size_t i = first; i < last; ++i) {
    stop.now();
    if (!is_valid(rays[i])) [[unlikely]] {
      answer(i, nullptr, counts);
      continue;
    }
    ++counts.rays;
    const auto asked = asked_of(impl.geometries, rays[i], options, i, counts.ladder);
    hits.start(asked, i, all);
    answer(i, &hits, counts);
  }
}

/// A batch of these from door to door.
template <class Impl, class Real, class Answer>
void answer_step_by_step(const Impl& impl, std::span<const Ray<Real>> rays, std::size_t results,
                         const BatchOptions& options, bool all, const Answer& answer) {
  validate_batch(impl.geometries, rays, results, options);
  CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    answer_rays(impl, rays, begin, end, options, all, counts, answer);
    sum.add(counts);
  };
  constexpr std::size_t kGrain = 64;  // what a filter does may take long
  for_chunks(rays.size(), options.work, kGrain, chunk);
}

}  // namespace pierce::scene
