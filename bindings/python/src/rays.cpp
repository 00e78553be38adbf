// SPDX-License-Identifier: Apache-2.0
//
// What rays are asked.
#include <algorithm>
#include <array>
#include <cstring>

#include "columns.h"
#include "scene.h"

namespace pierce::python {
namespace {

// BatchOptions, and the arrays that they look at.
class Batch {
 public:
  explicit Batch(const Question& question)
      : masks_(question.masks, "mask"),
        skip_(question.skip, "skip"),
        after_(question.after, "after") {
    options_.range = question.open_start ? Range::OpenStart : Range::Closed;
    options_.sides = static_cast<Sides>(question.sides);
    options_.distinct = question.distinct;
    options_.invalid = question.invalid_miss ? InvalidRays::Miss : InvalidRays::Throw;
    options_.max_hits = question.max_hits;
    options_.mask = question.mask;
    options_.masks = masks_.packed<const std::uint32_t, const std::uint32_t>();
    options_.skip = skip_.packed<const TriangleRef, const std::uint32_t>(2);
    options_.after = after_.packed<const TriangleRef, const std::uint32_t>(2);
  }
  [[nodiscard]] BatchOptions with(const WorkOptions& work) const {
    BatchOptions options = options_;
    options.work = work;
    return options;
  }

 private:
  Buffer masks_, skip_, after_;
  BatchOptions options_;
};

template <class Real>
std::size_t count_of(const RayArrays<Real>& rays) {
  return std::max({rays.origins.count, rays.directions.count, rays.t_min.count, rays.t_max.count});
}

template <class T>
T number_at(const Rows<const T>& rows, std::size_t row, std::size_t component) {
  const std::size_t i = rows.count == 1 ? 0 : row;
  T value;
  std::memcpy(&value,
              reinterpret_cast<const std::byte*>(rows.data) +
                  static_cast<std::ptrdiff_t>(i) * rows.stride +
                  static_cast<std::ptrdiff_t>(component) * rows.step,
              sizeof value);
  return value;
}

template <class Real>
Vec3<Real> vector_at(const Rows<const Real>& rows, std::size_t row) {
  return {number_at(rows, row, 0), number_at(rows, row, 1), number_at(rows, row, 2)};
}

template <class Real>
Ray<Real> ray_at(const RayArrays<Real>& rays, std::size_t i) {
  Ray<Real> ray{vector_at(rays.origins, i), vector_at(rays.directions, i)};
  if (!rays.t_min.empty()) ray.t_min = number_at(rays.t_min, i, 0);
  if (!rays.t_max.empty()) ray.t_max = number_at(rays.t_max, i, 0);
  return ray;
}

// Rays and hits for those queries that want them as the library has them: some at a time, so that
// memory does not grow with their number.
constexpr std::size_t kTile = 16384;

template <class Real, class Ask>
void for_tiles(const RayArrays<Real>& rays, std::span<const TriangleRef> hits, const Ask& ask) {
  std::vector<Ray<Real>> ray_tile(std::min(kTile, hits.size()));
  std::vector<Hit<Real>> hit_tile(ray_tile.size());
  for (std::size_t first = 0; first < hits.size(); first += kTile) {
    const std::size_t size = std::min(kTile, hits.size() - first);
    for (std::size_t i = 0; i < size; ++i) {
      ray_tile[i] = ray_at(rays, first + i);
      hit_tile[i] = {};
      hit_tile[i].geometry = hits[first + i].geometry;
      hit_tile[i].triangle = hits[first + i].triangle;
    }
    ask(first, std::span<const Ray<Real>>(ray_tile.data(), size),
        std::span<const Hit<Real>>(hit_tile.data(), size));
  }
}

}  // namespace

template <class Real>
HitColumns<Real>::HitColumns(const nb::tuple& columns) {
  constexpr std::array kNames = {"t",        "u",      "v",      "w",      "geometry",
                                 "triangle", "facing", "points", "normals"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    at_.emplace_back(columns[i], kNames[i], Access::Write);
  }
}

template <class Real>
void SceneOf<Real>::closest_hits(const RayTuple& ray_tuple, const nb::tuple& columns,
                                 const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const HitColumns<Real> wanted(columns);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const HitArrays<Real> hits = wanted.get();
  const Asking scene(*this);
  run(question.control, length(count_of(rays)),
      [&](const WorkOptions& work) { scene->closest_hits(rays, hits, batch.with(work)); });
}

template <class Real>
void SceneOf<Real>::any_hits(const RayTuple& ray_tuple, nb::handle hits, const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer out(hits, "hits", Access::Write);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const Rows<std::uint8_t> rows = out.rows<std::uint8_t>();
  const Asking scene(*this);
  run(question.control, length(count_of(rays)),
      [&](const WorkOptions& work) { scene->any_hits(rays, rows, batch.with(work)); });
}

template <class Real>
void SceneOf<Real>::count_hits(const RayTuple& ray_tuple, nb::handle counts,
                               const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer out(counts, "counts", Access::Write);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const Rows<std::uint32_t> rows = out.rows<std::uint32_t>();
  const Asking scene(*this);
  run(question.control, length(count_of(rays), Reach::All),
      [&](const WorkOptions& work) { scene->count_hits(rays, rows, batch.with(work)); });
}

template <class Real>
void SceneOf<Real>::crossings(const RayTuple& ray_tuple, const nb::tuple& columns,
                              const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer count(columns[0], "count", Access::Write);
  const Buffer signed_count(columns[1], "signed_count", Access::Write);
  const Buffer on_surface(columns[2], "origin_on_surface", Access::Write);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const CrossingsArrays results{.count = count.rows<std::uint32_t>(),
                                .signed_count = signed_count.rows<std::int32_t>(),
                                .origin_on_surface = on_surface.rows<std::uint8_t>()};
  const Asking scene(*this);
  run(question.control, length(count_of(rays), Reach::All),
      [&](const WorkOptions& work) { scene->crossings(rays, results, batch.with(work)); });
}

template <class Real>
nb::tuple SceneOf<Real>::all_hits(const RayTuple& ray_tuple, nb::handle offsets,
                                  const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer out(offsets, "offsets", Access::Write);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const std::span<std::int64_t> ends = out.packed<std::int64_t, std::int64_t>();
  if (ends.size() != count_of(rays) + 1) throw nb::value_error("offsets: one more than rays");
  ends[0] = 0;
  GrowingHits<Real> hits;
  {
    const Asking scene(*this);
    run(question.control, length(count_of(rays), Reach::All), [&](const WorkOptions& work) {
      scene->all_hits(rays, batch.with(work),
                      HitRoom<Real>([&](std::uint64_t first, auto piece_offsets) {
                        const std::size_t before = hits.size();
                        for (std::size_t i = 1; i < piece_offsets.size(); ++i) {
                          ends[first + i] = static_cast<std::int64_t>(before + piece_offsets[i]);
                        }
                        return hits.more(piece_offsets.back());
                      }));
    });
  }
  return hits.release();
}

template <class Real>
void SceneOf<Real>::hit_points(const RayTuple& ray_tuple, nb::handle hits, nb::handle points,
                               const Control& control) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer hit_buffer(hits, "hits"), out(points, "points", Access::Write);
  const RayArrays<Real> rays = kept.get();
  const auto refs = hit_buffer.packed<const TriangleRef, const std::uint32_t>(2);
  const auto results = out.packed<Vec3<Real>, Real>(3);
  if (refs.size() != count_of(rays) || results.size() != refs.size()) {
    throw nb::value_error("as many hits and points as rays");
  }
  const Asking scene(*this);
  run(control, length(refs.size()), [&](const WorkOptions& work) {
    for_tiles(rays, refs, [&](std::size_t first, auto ray_tile, auto hit_tile) {
      scene->hit_points(ray_tile, hit_tile, results.subspan(first, hit_tile.size()),
                        {.threads = work.threads, .stop = work.stop});
      if (work.progress) {
        work.progress(static_cast<double>(first + hit_tile.size()) /
                      static_cast<double>(refs.size()));
      }
    });
  });
}

template <class Real>
void SceneOf<Real>::next_origins(const RayTuple& ray_tuple, nb::handle hits, bool beyond,
                                 nb::handle points, const Control& control) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer hit_buffer(hits, "hits"), out(points, "points", Access::Write);
  const RayArrays<Real> rays = kept.get();
  const auto refs = hit_buffer.packed<const TriangleRef, const std::uint32_t>(2);
  const auto results = out.packed<Vec3<Real>, Real>(3);
  if (refs.size() != count_of(rays) || results.size() != refs.size()) {
    throw nb::value_error("as many hits and points as rays");
  }
  constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
  const Side side = beyond ? Side::Beyond : Side::Before;
  const Asking scene(*this);
  run(control, length(refs.size()), [&](const WorkOptions& work) {
    std::vector<std::optional<Vec3<Real>>> starts(std::min(kTile, refs.size()));
    for_tiles(rays, refs, [&](std::size_t first, auto ray_tile, auto hit_tile) {
      const auto tile = std::span(starts).first(hit_tile.size());
      BatchOptions options;
      options.work.threads = work.threads;
      options.work.stop = work.stop;
      scene->next_origins(ray_tile, hit_tile, side, tile, options);
      for (std::size_t i = 0; i < tile.size(); ++i) {
        results[first + i] = tile[i].value_or(Vec3<Real>{kNan, kNan, kNan});
      }
      if (work.progress) {
        work.progress(static_cast<double>(first + tile.size()) / static_cast<double>(refs.size()));
      }
    });
  });
}

template <class Real>
void SceneOf<Real>::normals(nb::handle hits, bool unit, nb::handle out, const Control& control) {
  const Buffer hit_buffer(hits, "hits"), normal_buffer(out, "normals", Access::Write);
  const auto refs = hit_buffer.packed<const TriangleRef, const std::uint32_t>(2);
  const auto results = normal_buffer.packed<Vec3<Real>, Real>(3);
  const Asking scene(*this);
  run(control, length(refs.size()), [&](const WorkOptions& work) {
    if (unit) {
      scene->unit_normals(refs, results, work);
    } else {
      scene->normals(refs, results, work);
    }
  });
}

#define PIERCE_RAYS(Real)                                                                        \
  template class HitColumns<Real>;                                                               \
  template void SceneOf<Real>::closest_hits(const RayTuple&, const nb::tuple&, const Question&); \
  template void SceneOf<Real>::any_hits(const RayTuple&, nb::handle, const Question&);           \
  template void SceneOf<Real>::count_hits(const RayTuple&, nb::handle, const Question&);         \
  template void SceneOf<Real>::crossings(const RayTuple&, const nb::tuple&, const Question&);    \
  template nb::tuple SceneOf<Real>::all_hits(const RayTuple&, nb::handle, const Question&);      \
  template void SceneOf<Real>::hit_points(const RayTuple&, nb::handle, nb::handle,               \
                                          const Control&);                                       \
  template void SceneOf<Real>::next_origins(const RayTuple&, nb::handle, bool, nb::handle,       \
                                            const Control&);                                     \
  template void SceneOf<Real>::normals(nb::handle, bool, nb::handle, const Control&)

PIERCE_RAYS(float);
PIERCE_RAYS(double);

}  // namespace pierce::python
