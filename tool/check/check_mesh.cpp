// SPDX-License-Identifier: Apache-2.0
#include "check/check_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "check/difference.h"
#include "check/hard_rays.h"
#include "check/oracle.h"
#include "interrupt.h"
#include "one_mesh.h"
#include "progress_bar.h"
#include "stopwatch.h"
#include "support/parallel.h"

namespace pierce::tool {
namespace {

constexpr std::size_t kChunk = 4096;  // rays between two looks at the clock and the signals

template <class Real>
class Checker {
 public:
  Checker(const std::string& name, std::span<const MeshView<Real>> meshes, const Scene<Real>& scene,
          const CheckOptions& options)
      : name_(name),
        meshes_(meshes),
        together_(meshes),
        options_(options),
        oracle_(together_.view()),
        rays_of_(together_.view(), options.seed),
        scene_(scene) {}

  CheckResult run() {
    const Stopwatch watch;
    ProgressBar bar(name_);
    for (std::uint64_t first = 0; first < options_.rays; first += kChunk) {
      interrupt::check();
      bar.show(static_cast<double>(first) / static_cast<double>(options_.rays));
      check_chunk(first, std::min<std::uint64_t>(kChunk, options_.rays - first));
    }
    result_.rays = options_.rays;
    result_.seconds = watch.seconds();
    return result_;
  }

 private:
  using Hits = std::vector<Hit<Real>>;
  using Answer = typename Oracle<Real>::Answer;

  void check_chunk(std::uint64_t first, std::size_t count) {
    first_ = first;
    rays_.resize(count);
    expected_.resize(count);
    parallel::with_threads(options_.threads, [&] {
      parallel::for_each(std::size_t{0}, count, [&](std::size_t i) {
        rays_[i] = rays_of_(first + i);
        expected_[i] = oracle_.ask(rays_[i]);
        for (Hit<Real>& hit : expected_[i].hits) name_geometry(hit);
      });
    });
    for (const Answer& answer : expected_) {
      result_.hits += answer.hits.size();
      for (const Hit<Real>& hit : answer.hits) {
        result_.on_edge += hit.u == 0 || hit.v == 0 || hit.w == 0 ? 1 : 0;
      }
    }
    check_batches(Range::Closed);
    check_batches(Range::OpenStart);
    check_crossings();
    check_single();
  }

  // The oracle knows one mesh.
  void name_geometry(Hit<Real>& hit) const {
    const TriangleRef ref = together_.ref(hit.triangle);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
  }

  // The oracle's list for ray i, without what the range leaves out.
  std::span<const Hit<Real>> expected(std::size_t i, Range range) const {
    const std::span<const Hit<Real>> hits(expected_[i].hits);
    return range == Range::Closed ? hits : hits.subspan(expected_[i].at_start);
  }

  void check_batches(Range range) {
    BatchOptions batch;
    batch.work.threads = options_.threads;
    batch.range = range;
    batch.work.stop = interrupt::stop();
    batch.work.statistics = &result_.statistics;
    const char* open = range == Range::Closed ? "" : ", open start";

    Hits closest(rays_.size());
    scene_.closest_hits(rays_, closest, batch);
    std::vector<std::uint8_t> any(rays_.size());
    scene_.any_hits(rays_, any, batch);
    const HitLists<Real> lists = scene_.all_hits(rays_, batch);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::span<const Hit<Real>> all = expected(i, range);
      compare_first("closest_hits", open, i, all, closest[i]);
      compare_any("any_hits", open, i, all, any[i] != 0);
      compare_all("all_hits (batch)", open, i, all, lists.of(i));
    }
  }

  void check_crossings() {
    BatchOptions batch;
    batch.work.threads = options_.threads;
    batch.work.stop = interrupt::stop();
    std::vector<Crossings> got(rays_.size());
    scene_.crossings(rays_, got, batch);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      compare_crossings("crossings (batch)", i, got[i]);
      compare_crossings("crossings", i, scene_.crossings(rays_[i]));
    }
  }

  void check_single() {
    Hits list;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::span<const Hit<Real>> all = expected(i, Range::Closed);
      const std::optional<Hit<Real>> closest = scene_.closest_hit(rays_[i]);
      compare_first("closest_hit", "", i, all, closest.value_or(Hit<Real>{}));
      compare_any("any_hit", "", i, all, scene_.any_hit(rays_[i]));
      scene_.all_hits(rays_[i], list);
      compare_all("all_hits", "", i, all, list);
    }
  }

  void compare_first(const char* query, const char* open, std::size_t i,
                     std::span<const Hit<Real>> all, const Hit<Real>& got) {
    const Hit<Real> first = all.empty() ? Hit<Real>{} : all.front();
    if (!identical(first, got)) differ(query, open, i, {&first, 1}, {&got, 1});
  }

  void compare_any(const char* query, const char* open, std::size_t i,
                   std::span<const Hit<Real>> all, bool got) {
    if (got != !all.empty()) differ(query, got ? ": got a hit" : open, i, all, {});
  }

  void compare_all(const char* query, const char* open, std::size_t i,
                   std::span<const Hit<Real>> all, std::span<const Hit<Real>> got) {
    if (!std::equal(all.begin(), all.end(), got.begin(), got.end(), identical<Real>)) {
      differ(query, open, i, all, got);
    }
  }

  void compare_crossings(const char* query, std::size_t i, const Crossings& got) {
    const Crossings& right = expected_[i].crossings;
    if (got == right) return;
    const auto text = [](const Crossings& c) {
      return fmt::format("{} {} {}", c.count, c.signed_count, c.origin_on_surface);
    };
    differ(query, fmt::format(": expected {}, got {}", text(right), text(got)), i,
           expected_[i].hits, {});
  }

  void differ(const char* query, const std::string& more, std::size_t i,
              std::span<const Hit<Real>> expected, std::span<const Hit<Real>> got) {
    if (result_.differences++ != 0) return;
    const std::string where = fmt::format("{}: first difference: {}{}, ray {} of seed {}", name_,
                                          query, more, first_ + i, options_.seed);
    result_.first = describe_difference(where, meshes_, rays_[i], expected, got);
  }

  std::string name_;
  std::span<const MeshView<Real>> meshes_;
  OneMesh<Real> together_;
  CheckOptions options_;
  Oracle<Real> oracle_;
  HardRays<Real> rays_of_;
  const Scene<Real>& scene_;
  CheckResult result_;

  std::uint64_t first_ = 0;  // of the current chunk
  std::vector<Ray<Real>> rays_;
  std::vector<Answer> expected_;
};

}  // namespace

template <class Real>
CheckResult check_mesh(const std::string& name, std::span<const MeshView<Real>> meshes,
                       const Scene<Real>& scene, const CheckOptions& options) {
  return Checker<Real>(name, meshes, scene, options).run();
}

template CheckResult check_mesh(const std::string&, std::span<const MeshView<float>>,
                                const Scene<float>&, const CheckOptions&);
template CheckResult check_mesh(const std::string&, std::span<const MeshView<double>>,
                                const Scene<double>&, const CheckOptions&);

}  // namespace pierce::tool
