// SPDX-License-Identifier: Apache-2.0
//
// Batches whose rays go one by one: those of the queries about all hits.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "scene/rays/ray_source.h"
#include "scene/rays/sight.h"
#include "scene/validate_input.h"
#include "support/for_chunks.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// A batch from door to door: checks it, spreads it over threads, and has `answer(ray, sight,
/// listener, counts)` make each result, which `write(first, results)` takes tile by tile. A
/// thread's `Listener` serves all its rays.
template <class Listener, class Result, class Impl, class Real, class Answer, class Write>
void answer_one_by_one(const Impl& impl, const RaySource<Real>& rays, const BatchOptions& options,
                       const Answer& answer, const Write& write) {
  validate_batch(impl.geometries, rays, options);
  CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    Listener listener(impl.geometries, StopPoll(options.work.stop), counts.ladder);
    std::array<Result, kernels::kBlockSize> results;
    for (std::size_t first = begin; first < end; first += results.size()) {
      const std::size_t size = std::min(results.size(), end - first);
      for (std::size_t i = 0; i < size; ++i) {
        const std::size_t ray = first + i;
        results[i] = answer(rays[ray], sight_of(impl.geometries, options, ray), listener, counts);
      }
      write(first, std::span<const Result>(results).first(size));
    }
    sum.add(counts);
  };
  for_chunks(rays.size(), options.work, kRaysPerTask, chunk);
}

}  // namespace pierce::scene
