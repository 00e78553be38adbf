// SPDX-License-Identifier: Apache-2.0
//
// Every hit: of one ray, of a batch as a whole, of a batch piece by piece; and how many there are.
#include <algorithm>
#include <utility>
#include <vector>

#include "scene/rays/list_collector.h"
#include "scene/rays/one_by_one.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"
#include "support/parallel.h"

namespace pierce {
namespace {

// A piece that is handed over holds fewer hits beside those of its last ray.
constexpr std::size_t kHitsPerPiece = std::size_t{1} << 16;
constexpr std::size_t kPiecesPerThread = 4;

// Some rays of a batch, and their lists as far as they are made.
template <class Real>
struct Piece {
  std::size_t begin = 0, end = 0;
  HitLists<Real> lists;

  [[nodiscard]] std::size_t made() const { return begin + lists.offsets.size() - 1; }
};

// A batch of which lists are made.
template <class Real, class Impl>
struct ListBatch {
  const Impl& impl;
  const scene::RaySource<Real>& rays;
  const BatchOptions& options;
  scene::CountSum<typename Impl::Counts>& sum;

  // Makes the lists of the piece's rays, but stops when there are `enough` hits.
  void make(Piece<Real>& piece, std::size_t enough) const {
    auto counts = sum.start();
    scene::ListCollector<Real> collector(*impl.kernel, impl.geometries,
                                         scene::StopPoll(options.work.stop), counts.ladder);
    scene::CountedHits<Real> counted(impl, options, scene::StopPoll(options.work.stop), counts);
    HitLists<Real>& lists = piece.lists;
    lists.hits.clear();
    lists.offsets.reserve(piece.end - piece.begin + 1);
    lists.offsets.assign(1, 0);
    for (std::size_t i = piece.begin; i < piece.end && lists.hits.size() < enough; ++i) {
      const Ray<Real> ray = rays[i];
      if (scene::is_valid(ray)) [[likely]] {
        const auto asked = scene::asked_of(impl.geometries, ray, options, i, counts.ladder);
        if (scene::counts_one_by_one(options)) {
          impl.all(asked, i, options.max_hits, counted, lists.hits, counts);
        } else {
          impl.all(asked.ray(), options.range, asked.sight(), options.max_hits, collector,
                   lists.hits, counts);
        }
      }
      lists.offsets.push_back(lists.hits.size());
      make_room(piece, enough);
    }
    sum.add(counts);
  }

  // For what the rest of the rays will hit if they are like those before: a vector that grows as it
  // pleases touches twice the memory that it ends with, and fresh pages cost as much as hits.
  static void make_room(Piece<Real>& piece, std::size_t enough) {
    std::vector<Hit<Real>>& hits = piece.lists.hits;
    const std::size_t rays = piece.made() - piece.begin, left = piece.end - piece.made();
    if (hits.capacity() - hits.size() >= hits.size() / rays + 1 || left == 0) return;
    const std::size_t likely = hits.size() + hits.size() / rays * left + left;
    const std::size_t most = hits.size() < kHitsPerPiece ? 8 * hits.size() : 2 * hits.size();
    hits.reserve(std::min({likely, most, std::max(enough, hits.size())}));
  }

  // Hands over the lists of the rays begin ... end - 1 in pieces of at most `rays_per_piece`.
  // What is left of a piece that was full before its end comes after it, a ray a piece: those are
  // never full before their end.
  template <class HandOver>
  void stream(std::size_t begin, std::size_t end, std::size_t rays_per_piece,
              const HandOver& hand_over) const {
    const WorkOptions quiet{.threads = options.work.threads, .stop = options.work.stop};
    std::vector<Piece<Real>> pieces(kPiecesPerThread *
                                    parallel::thread_count(options.work.threads));
    std::size_t next = begin;
    while (next < end) {
      std::size_t used = 0;
      for (; used < pieces.size() && next < end; ++used) {
        pieces[used].begin = next;
        next = std::min(end, next + rays_per_piece);
        pieces[used].end = next;
      }
      scene::for_chunks(used, quiet, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) make(pieces[i], kHitsPerPiece);
      });
      for (std::size_t i = 0; i < used; ++i) {
        hand_over(pieces[i].begin, pieces[i].lists);
        stream(pieces[i].made(), pieces[i].end, 1, hand_over);
      }
      rays_per_piece = better_size(rays_per_piece, std::span(pieces).first(used));
    }
  }

  // So many rays that the fullest of the pieces would have been half full, or twice as many.
  static std::size_t better_size(std::size_t rays_per_piece, std::span<const Piece<Real>> pieces) {
    std::size_t best = std::min(scene::kRaysPerTask, 2 * rays_per_piece);
    for (const Piece<Real>& piece : pieces) {
      const std::size_t hits_per_ray = piece.lists.hits.size() / (piece.made() - piece.begin) + 1;
      best = std::min(best, std::max<std::size_t>(1, kHitsPerPiece / 2 / hits_per_ray));
    }
    return best;
  }
};

}  // namespace

template <class Real>
void Scene<Real>::Impl::all(const Ray<Real>& ray, Range range, const scene::Sight& sight,
                            std::uint64_t most, scene::ListCollector<Real>& collector,
                            std::vector<Hit<Real>>& out, Counts& counts) const {
  if (!tell_all(ray, range, sight, collector, counts)) return;
  const std::size_t before = out.size();
  collector.append_ordered(most, out);
  counts.hits += out.size() - before;
}

template <class Real>
void Scene<Real>::Impl::all(const scene::Asked<Real>& asked, std::uint64_t number,
                            std::uint64_t most, scene::CountedHits<Real>& counted,
                            std::vector<Hit<Real>>& out, Counts& counts) const {
  ++counts.rays;
  const std::size_t before = out.size();
  counted.start(asked, number, true);
  counted.append(most, out);
  counts.hits += out.size() - before;
}

template <class Real>
std::uint32_t Scene<Real>::Impl::count(const Ray<Real>& ray, Range range, const scene::Sight& sight,
                                       scene::HitCounter<Real>& counter, Counts& counts) const {
  if (!tell_all(ray, range, sight, counter, counts)) return 0;
  const std::uint32_t count = counter.count();
  counts.hits += count;
  return count;
}

template <class Real>
void Scene<Real>::all_hits(const Ray<Real>& ray, std::vector<Hit<Real>>& out,
                           const QueryOptions& options) const {
  const FloatEnvironment environment;
  out.clear();
  if (!scene::is_valid_or_throw(ray, options.invalid)) return;
  typename Impl::Counts counts;
  const scene::Sight sight = scene::sight_of(impl_->geometries, options);
  scene::validate_after(impl_->geometries, ray, options.after);
  const scene::Asked<Real> asked(impl_->geometries, ray, sight, options.after, options.distinct,
                                 counts.ladder);
  if (scene::counts_one_by_one(options)) {
    scene::CountedHits<Real> counted(*impl_, options, {}, counts);
    impl_->all(asked, 0, options.max_hits, counted, out, counts);
    return;
  }
  scene::ListCollector<Real> collector(*impl_->kernel, impl_->geometries, {}, counts.ladder);
  impl_->all(asked.ray(), options.range, asked.sight(), options.max_hits, collector, out, counts);
}

template <class Real>
std::uint32_t Scene<Real>::count_hits(const Ray<Real>& ray, const QueryOptions& options) const {
  const FloatEnvironment environment;
  if (!scene::is_valid_or_throw(ray, options.invalid)) return 0;
  typename Impl::Counts counts;
  const scene::Sight sight = scene::sight_of(impl_->geometries, options);
  scene::validate_after(impl_->geometries, ray, options.after);
  const scene::Asked<Real> asked(impl_->geometries, ray, sight, options.after, options.distinct,
                                 counts.ladder);
  if (scene::counts_one_by_one(options)) {
    scene::CountedHits<Real> counted(*impl_, options, {}, counts);
    counted.start(asked, 0, true);
    return counted.count();
  }
  scene::HitCounter<Real> counter(impl_->geometries, {}, counts.ladder);
  return impl_->count(asked.ray(), options.range, asked.sight(), counter, counts);
}

template <class Real>
HitLists<Real> Scene<Real>::all_hits(const RayArrays<Real>& arrays,
                                     const BatchOptions& options) const {
  const FloatEnvironment environment;
  const scene::RaySource<Real> rays(arrays);
  scene::validate_batch(impl_->geometries, rays, options);
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  const ListBatch<Real, Impl> batch{*impl_, rays, options, sum};
  std::vector<Piece<Real>> pieces((rays.size() + scene::kRaysPerTask - 1) / scene::kRaysPerTask);
  scene::for_chunks(pieces.size(), options.work, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      pieces[i].begin = i * scene::kRaysPerTask;
      pieces[i].end = std::min(rays.size(), pieces[i].begin + scene::kRaysPerTask);
      batch.make(pieces[i], kUnlimited);
    }
  });
  if (pieces.size() == 1) return std::move(pieces.front().lists);
  std::size_t hits = 0;
  for (const Piece<Real>& piece : pieces) hits += piece.lists.hits.size();
  HitLists<Real> all;
  all.hits.reserve(hits);
  all.offsets.reserve(rays.size() + 1);
  all.offsets.push_back(0);
  const scene::StopPoll stop(options.work.stop);
  for (const auto& [begin, end, lists] : pieces) {
    for (std::size_t i = 1; i < lists.offsets.size(); ++i) {
      all.offsets.push_back(all.hits.size() + lists.offsets[i]);
    }
    std::span<const Hit<Real>> rest(lists.hits);
    do {  // the list of one ray may be long
      stop.now();
      const auto some = rest.first(std::min(rest.size(), kHitsPerPiece));
      all.hits.insert(all.hits.end(), some.begin(), some.end());
      rest = rest.subspan(some.size());
    } while (!rest.empty());
  }
  return all;
}

template <class Real>
void Scene<Real>::all_hits(const RayArrays<Real>& arrays, const BatchOptions& options,
                           const HitListsConsumer<Real>& consume) const {
  const FloatEnvironment environment;
  const scene::RaySource<Real> rays(arrays);
  scene::validate_batch(impl_->geometries, rays, options);
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  const ListBatch<Real, Impl> batch{*impl_, rays, options, sum};
  batch.stream(
      0, rays.size(), scene::kRaysPerTask, [&](std::size_t first, const HitLists<Real>& lists) {
        consume(first, lists);
        const std::size_t done = first + lists.offsets.size() - 1;
        if (!options.work.progress) return;
        options.work.progress(static_cast<double>(done) / static_cast<double>(rays.size()));
      });
}

template <class Real>
void Scene<Real>::all_hits(const RayArrays<Real>& rays, const BatchOptions& options,
                           const HitRoom<Real>& room) const {
  const FloatEnvironment environment;
  const scene::RaySource<Real> source(rays);
  const auto consume = [&](std::uint64_t first, const HitLists<Real>& lists) {
    const scene::HitTiles<Real> hits(room(first, lists.offsets), lists.hits.size());
    hits.write(0, lists.hits);
    if (!hits.places().wanted()) return;
    for (std::size_t ray = 0; ray + 1 < lists.offsets.size(); ++ray) {
      for (std::uint64_t i = lists.offsets[ray]; i < lists.offsets[ray + 1]; ++i) {
        hits.places().write(i, source[first + ray], lists.hits[i], impl_->geometries);
      }
    }
  };
  all_hits(rays, options, HitListsConsumer<Real>(consume));
}

template <class Real>
HitLists<Real> Scene<Real>::all_hits(std::span<const Ray<Real>> rays,
                                     const BatchOptions& options) const {
  return all_hits(RayArrays<Real>::of(rays), options);
}
template <class Real>
void Scene<Real>::all_hits(std::span<const Ray<Real>> rays, const BatchOptions& options,
                           const HitListsConsumer<Real>& consume) const {
  all_hits(RayArrays<Real>::of(rays), options, consume);
}

template <class Real>
void Scene<Real>::count_hits(const RayArrays<Real>& rays, const Rows<std::uint32_t>& counts,
                             const BatchOptions& options) const {
  const FloatEnvironment environment;
  const scene::RaySource<Real> source(rays);
  scene::validate_outputs("ray", source.size(), counts.count);
  const scene::OutputRows<std::uint32_t> out(counts, source.size(), "ray", "counts");
  const auto write = [&](std::size_t first, std::span<const std::uint32_t> results) {
    out.write(first, results, [](std::uint32_t count) { return count; });
  };
  if (scene::counts_one_by_one(options)) {
    const auto answer = [](scene::CountedHits<Real>* hits, auto& sums) {
      const std::uint32_t count = hits == nullptr ? 0 : hits->count();
      sums.hits += count;
      return count;
    };
    scene::answer_step_by_step<std::uint32_t>(*impl_, source, options, true, answer, write);
    return;
  }
  scene::answer_one_by_one<scene::HitCounter<Real>, std::uint32_t>(
      *impl_, source, options,
      [&](const Ray<Real>& ray, const scene::Sight& sight, auto& counter, auto& sums) {
        return impl_->count(ray, options.range, sight, counter, sums);
      },
      write);
}
template <class Real>
void Scene<Real>::count_hits(std::span<const Ray<Real>> rays, std::span<std::uint32_t> counts,
                             const BatchOptions& options) const {
  count_hits(RayArrays<Real>::of(rays), rows(counts), options);
}

#define PIERCE_INSTANTIATE(Real)                                                                 \
  template void Scene<Real>::Impl::all(const Ray<Real>&, Range, const scene::Sight&,             \
                                       std::uint64_t, scene::ListCollector<Real>&,               \
                                       std::vector<Hit<Real>>&, Counts&) const;                  \
  template void Scene<Real>::Impl::all(const scene::Asked<Real>&, std::uint64_t, std::uint64_t,  \
                                       scene::CountedHits<Real>&, std::vector<Hit<Real>>&,       \
                                       Counts&) const;                                           \
  template std::uint32_t Scene<Real>::Impl::count(const Ray<Real>&, Range, const scene::Sight&,  \
                                                  scene::HitCounter<Real>&, Counts&) const;      \
  template void Scene<Real>::all_hits(const Ray<Real>&, std::vector<Hit<Real>>&,                 \
                                      const QueryOptions&) const;                                \
  template std::uint32_t Scene<Real>::count_hits(const Ray<Real>&, const QueryOptions&) const;   \
  template HitLists<Real> Scene<Real>::all_hits(const RayArrays<Real>&, const BatchOptions&)     \
      const;                                                                                     \
  template void Scene<Real>::all_hits(const RayArrays<Real>&, const BatchOptions&,               \
                                      const HitListsConsumer<Real>&) const;                      \
  template void Scene<Real>::all_hits(const RayArrays<Real>&, const BatchOptions&,               \
                                      const HitRoom<Real>&) const;                               \
  template void Scene<Real>::count_hits(const RayArrays<Real>&, const Rows<std::uint32_t>&,      \
                                        const BatchOptions&) const;                              \
  template HitLists<Real> Scene<Real>::all_hits(std::span<const Ray<Real>>, const BatchOptions&) \
      const;                                                                                     \
  template void Scene<Real>::all_hits(std::span<const Ray<Real>>, const BatchOptions&,           \
                                      const HitListsConsumer<Real>&) const;                      \
  template void Scene<Real>::count_hits(std::span<const Ray<Real>>, std::span<std::uint32_t>,    \
                                        const BatchOptions&) const

PIERCE_INSTANTIATE(float);
PIERCE_INSTANTIATE(double);

}  // namespace pierce
