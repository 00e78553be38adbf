// SPDX-License-Identifier: Apache-2.0
//
// Batches whose rays go one by one: those of the queries about all hits.
#pragma once

#include <cstddef>
#include <span>

#include "scene/rays/sight.h"
#include "scene/validate_input.h"
#include "support/for_chunks.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// A batch from door to door: checks it, spreads it over threads, and has `answer(ray, sight,
/// sink, counts)` make each result. A thread's `CandidateSink` serves all its rays.
template <class CandidateSink, class Impl, class Real, class Result, class Answer>
void answer_one_by_one(const Impl& impl, std::span<const Ray<Real>> rays, std::span<Result> results,
                       const BatchOptions& options, const Answer& answer) {
  validate_batch(impl.geometries, rays, results.size(), options);
  CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    CandidateSink sink(impl.geometries, StopPoll(options.work.stop), counts.ladder);
    for (std::size_t i = begin; i < end; ++i) {
      results[i] = answer(rays[i], sight_of(impl.geometries, options, i), sink, counts);
    }
    sum.add(counts);
  };
  for_chunks(rays.size(), options.work, kRaysPerTask, chunk);
}

}  // namespace pierce::scene
