// SPDX-License-Identifier: Apache-2.0
//
// One piece of a cast: some rays, read or made, asked about. Rays that are made are cast by the
// thread that made them, a few at a time, so that they need not leave its caches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cast_options.h"
#include "pierce/error.h"
#include "pierce/scene.h"
#include "ray_options.h"
#include "support/for_chunks.h"
#include "support/lock.h"

namespace pierce::tool {

/// The same for rays that are all there before the first is cast: those of a file.
template <class Real, class Asker>
std::uint64_t cast_read_piece(const Scene<Real>& scene, const RayStream& source,
                              std::uint64_t first, std::size_t size, Asker& asker,
                              const BatchOptions& options) {
  thread_local std::vector<Ray<Real>> rays;
  rays.resize(size);
  source.read(first, std::span(rays));
  std::uint64_t found = 0;
  naming_rays<Real>(source.name(), first, scene, rays, [&] {
    if constexpr (requires { asker.make_room(size); }) {
      asker.make_room(size);
      asker.ask(scene, rays, 0, options);
      found = asker.finish_piece();
    } else {
      found = asker.ask(scene, rays, options);
    }
  });
  return found;
}

/// Asks about rays first ... first + size - 1; returns how many hits (or passages) there were.
template <class Real, class Asker>
std::uint64_t cast_piece(const Scene<Real>& scene, const RayStream& source, std::uint64_t first,
                         std::size_t size, Asker& asker, const BatchOptions& options) {
  if constexpr (requires { asker.make_room(size); }) {
    if (source.is_made()) {
      constexpr std::size_t kAtOnce = 4096;
      asker.make_room(size);
      parallel::Mutex mutex;
      const auto cast = [&](std::size_t begin, std::size_t end) {
        thread_local std::vector<Ray<Real>> rays;
        rays.resize(end - begin);
        source.read(first + begin, std::span(rays));
        Statistics counts;
        BatchOptions part = options;
        part.work = {.threads = 1, .stop = options.work.stop};
        if (options.work.statistics != nullptr) part.work.statistics = &counts;
        asker.ask(scene, rays, begin, part);
        const parallel::Lock lock(mutex);
        if (options.work.statistics != nullptr) *options.work.statistics += counts;
      };
      try {
        scene::for_chunks(size, options.work, kAtOnce, cast);
        return asker.finish_piece();
      } catch (const Error& error) {
        if (error.code() != ErrorCode::InvalidRay) throw;
      }  // all of them again, to name the first bad one
    }
  }
  return cast_read_piece(scene, source, first, size, asker, options);
}

}  // namespace pierce::tool
