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

// Rays, their hits, and a point for each, for queries that want rays and hits as the library has
// them: some at a time, so that memory does not grow with their number.
constexpr std::size_t kTile = 16384;

template <class Real>
class PlacesOf {
 public:
  PlacesOf(const RayTuple& rays, nb::handle hits, nb::handle out)
      : kept_(rays), hit_buffer_(hits, "hits"), point_buffer_(out, "points", Access::Write) {
    if (hits_.size() != count_of(rays_) || points.size() != hits_.size()) {
      throw nb::value_error("as many hits and points as rays");
    }
  }

  /// `ask` gets a tile's rays, hits, points to be filled and WorkOptions.
  template <class Ask>
  void for_tiles(const WorkOptions& work, const Ask& ask) const {
    const WorkOptions tile_work{.threads = work.threads, .stop = work.stop};
    std::vector<Ray<Real>> rays(std::min(kTile, hits_.size()));
    std::vector<Hit<Real>> hits(rays.size());
    for (std::size_t first = 0; first < hits_.size(); first += kTile) {
      const std::size_t size = std::min(kTile, hits_.size() - first);
      for (std::size_t i = 0; i < size; ++i) {
        rays[i] = ray_at(rays_, first + i);
        hits[i] = {};
        hits[i].geometry = hits_[first + i].geometry;
        hits[i].triangle = hits_[first + i].triangle;
      }
      ask(std::span<const Ray<Real>>(rays.data(), size),
          std::span<const Hit<Real>>(hits.data(), size), points.subspan(first, size), tile_work);
      if (work.progress) {
        work.progress(static_cast<double>(first + size) / static_cast<double>(hits_.size()));
      }
    }
  }

 private:
  RaysOf<Real> kept_;
  Buffer hit_buffer_, point_buffer_;
  RayArrays<Real> rays_ = kept_.get();
  std::span<const TriangleRef> hits_ =
      hit_buffer_.packed<const TriangleRef, const std::uint32_t>(2);

 public:
  const std::span<Vec3<Real>> points = point_buffer_.packed<Vec3<Real>, Real>(3);
};

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
std::uint64_t SceneOf<Real>::closest_hits(const RayTuple& ray_tuple, const nb::tuple& columns,
                                          const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const HitColumns<Real> wanted(columns);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const HitArrays<Real> hits = wanted.get();
  const Asking scene(*this, question.version);
  run(question.control, length(count_of(rays)),
      [&](const WorkOptions& work) { scene->closest_hits(rays, hits, batch.with(work)); });
  return version_;
}

template <class Real>
nb::tuple SceneOf<Real>::closest_packed(const RayTuple& ray_tuple, const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const std::size_t count = count_of(rays);
  nb::object bytes = bytes_for(count * kHitBytes<Real>);
  const HitArrays<Real> hits = hit_columns<Real>({bytes, count});
  const Asking scene(*this, question.version);
  run(question.control, length(count),
      [&](const WorkOptions& work) { scene->closest_hits(rays, hits, batch.with(work)); });
  return nb::make_tuple(bytes, version_);
}

template <class Real>
void SceneOf<Real>::any_hits(const RayTuple& ray_tuple, nb::handle hits, const Question& question) {
  const RaysOf<Real> kept(ray_tuple);
  const Buffer out(hits, "hits", Access::Write);
  const Batch batch(question);
  const RayArrays<Real> rays = kept.get();
  const Rows<std::uint8_t> rows = out.rows<std::uint8_t>();
  const Asking scene(*this, question.version);
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
  const Asking scene(*this, question.version);
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
  const Asking scene(*this, question.version);
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
  std::uint64_t version = kAnyVersion;
  {
    const Asking scene(*this, question.version);
    version = version_;
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
  return nb::make_tuple(hits.release(), version);
}

template <class Real>
void SceneOf<Real>::hit_points(const RayTuple& rays, nb::handle hits, nb::handle points,
                               std::uint64_t version, const Control& control) {
  const PlacesOf<Real> asked(rays, hits, points);
  const Asking scene(*this, version);
  run(control, length(asked.points.size()), [&](const WorkOptions& work) {
    asked.for_tiles(work, [&](auto ray_tile, auto hit_tile, auto results, const auto& tile_work) {
      scene->hit_points(ray_tile, hit_tile, results, tile_work);
    });
  });
}

template <class Real>
void SceneOf<Real>::next_origins(const RayTuple& rays, nb::handle hits, bool beyond,
                                 nb::handle points, std::uint64_t version, const Control& control) {
  const PlacesOf<Real> asked(rays, hits, points);
  constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
  const Side side = beyond ? Side::Beyond : Side::Before;
  const Asking scene(*this, version);
  run(control, length(asked.points.size()), [&](const WorkOptions& work) {
    std::vector<std::optional<Vec3<Real>>> starts(std::min(kTile, asked.points.size()));
    asked.for_tiles(work, [&](auto ray_tile, auto hit_tile, auto results, const auto& tile_work) {
      const auto tile = std::span(starts).first(results.size());
      scene->next_origins(ray_tile, hit_tile, side, tile, {.work = tile_work});
      std::transform(tile.begin(), tile.end(), results.begin(), [](const auto& start) {
        return start.value_or(Vec3<Real>{kNan, kNan, kNan});
      });
    });
  });
}

template <class Real>
void SceneOf<Real>::normals(nb::handle hits, bool unit, nb::handle out, std::uint64_t version,
                            const Control& control) {
  const Buffer hit_buffer(hits, "hits"), normal_buffer(out, "normals", Access::Write);
  const auto refs = hit_buffer.packed<const TriangleRef, const std::uint32_t>(2);
  const auto results = normal_buffer.packed<Vec3<Real>, Real>(3);
  const Asking scene(*this, version);
  run(control, length(refs.size()), [&](const WorkOptions& work) {
    if (unit) {
      scene->unit_normals(refs, results, work);
    } else {
      scene->normals(refs, results, work);
    }
  });
}

#define PIERCE_RAYS(Real)                                                                         \
  template class HitColumns<Real>;                                                                \
  template std::uint64_t SceneOf<Real>::closest_hits(const RayTuple&, const nb::tuple&,           \
                                                     const Question&);                            \
  template void SceneOf<Real>::any_hits(const RayTuple&, nb::handle, const Question&);            \
  template void SceneOf<Real>::count_hits(const RayTuple&, nb::handle, const Question&);          \
  template void SceneOf<Real>::crossings(const RayTuple&, const nb::tuple&, const Question&);     \
  template nb::tuple SceneOf<Real>::closest_packed(const RayTuple&, const Question&);             \
  template nb::tuple SceneOf<Real>::all_hits(const RayTuple&, nb::handle, const Question&);       \
  template void SceneOf<Real>::hit_points(const RayTuple&, nb::handle, nb::handle, std::uint64_t, \
                                          const Control&);                                        \
  template void SceneOf<Real>::next_origins(const RayTuple&, nb::handle, bool, nb::handle,        \
                                            std::uint64_t, const Control&);                       \
  template void SceneOf<Real>::normals(nb::handle, bool, nb::handle, std::uint64_t, const Control&)

PIERCE_RAYS(float);
PIERCE_RAYS(double);

}  // namespace pierce::python
