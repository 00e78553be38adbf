// SPDX-License-Identifier: Apache-2.0
//
// What a Scene holds, and how one ray goes through it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bvh/tree.h"
#include "kernels/kernel.h"
#include "pierce/scene.h"
#include "predicate/decide.h"
#include "scene/geometries.h"
#include "scene/placed_meshes.h"
#include "scene/points/axis_points.h"
#include "scene/points/fill.h"
#include "scene/points/surface.h"
#include "scene/rays/counted_hits.h"
#include "scene/rays/hit_collector.h"
#include "scene/rays/hit_tiles.h"
#include "scene/rays/passage_counter.h"
#include "scene/rays/ray_source.h"
#include "scene/rays/ray_transform.h"
#include "scene/rays/sight.h"

namespace pierce {

template <class Real>
struct Scene<Real>::Impl {
  scene::PlacedMeshes<Real> placed;  // empty unless there are instances
  scene::Geometries<Real> geometries;
  bvh::Tree tree;
  Quality quality;
  double built_cost;  // the tree's sah_cost when its structure was made
  const kernels::Kernel* kernel;
  // Renewed when vertices have moved.
  std::unique_ptr<scene::LazySurface> surface = std::make_unique<scene::LazySurface>();
  std::unique_ptr<scene::LazyFill<Real>> fill = std::make_unique<scene::LazyFill<Real>>();

  /// Everything of a scene; `placed` is what the meshes view.
  static std::unique_ptr<Impl> build(std::span<const MeshView<Real>> meshes,
                                     scene::PlacedMeshes<Real> placed, const BuildOptions& options);
  /// Everything that hangs on positions; if it throws Error, nothing has changed.
  void refit(std::span<const MeshView<Real>> meshes, scene::PlacedMeshes<Real> moved,
             const WorkOptions& work);
  /// A tree over these, which must stay where they are if it keeps no copies.
  static bvh::Tree tree_over(const scene::Geometries<Real>& geometries, Quality quality,
                             const WorkOptions& work);

  /// Counters of one thread; nothing is counted when nobody asked.
  struct Counts {
    predicate::LadderCounts ladder;
    kernels::KernelCounts kernel;
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;
    std::uint64_t placed_exactly = 0;
    bool wanted = false;

    kernels::KernelCounts* kernel_counts() { return wanted ? &kernel : nullptr; }
    void add_to(Statistics& statistics) const;
  };

  void closest_hits(const scene::RaySource<Real>& rays, const scene::HitTiles<Real>& hits,
                    const BatchOptions& options) const;
  void any_hits(const scene::RaySource<Real>& rays, const scene::OutputRows<std::uint8_t>& hits,
                const BatchOptions& options) const;
  /// False if there is no hit; `hit` then is as it was.
  bool closest(const Ray<Real>& ray, Range range, const scene::Sight& sight, Hit<Real>& hit) const;
  bool any(const Ray<Real>& ray, Range range, const scene::Sight& sight) const;
  /// Of a valid ray under options that ask about its hits one by one.
  std::optional<Hit<Real>> first_counted(const Ray<Real>& ray, const QueryOptions& options) const;
  /// Has the LadderSink hear of every candidate. False if the ray passes the scene by, and the
  /// sink knows nothing of it.
  template <class Sink>
  bool tell_all(const Ray<Real>& ray, Range range, const scene::Sight& sight, Sink& sink,
                Counts& counts) const {
    space::FilterRay filter_ray;
    const scene::Transformed transformed =
        scene::transform(*kernel, geometries, ray, range, filter_ray);
    ++counts.rays;
    counts.placed_exactly += transformed.exactly ? 1 : 0;
    if (transformed.misses) return false;
    sink.start(predicate::to_double(ray, range), sight);
    kernel->all(tree, filter_ray, sight.skip, sink, counts.kernel_counts());
    return true;
  }
  /// Appends the first hits, `most` at most.
  void all(const Ray<Real>& ray, Range range, const scene::Sight& sight, std::uint64_t most,
           scene::HitCollector<Real>& collector, std::vector<Hit<Real>>& out, Counts& counts) const;
  /// The same of hits that are counted one by one.
  void all(const scene::Asked<Real>& asked, std::uint64_t number, std::uint64_t most,
           scene::CountedHits<Real>& counted, std::vector<Hit<Real>>& out, Counts& counts) const;
  std::uint32_t count(const Ray<Real>& ray, Range range, const scene::Sight& sight,
                      scene::HitCounter<Real>& counter, Counts& counts) const;
  /// Whether the point lies exactly on some closed triangle of those that are seen.
  bool on_surface(const Vec3<double>& point, const scene::Sight& sight) const;
  Crossings crossings(const Ray<Real>& ray, const scene::Sight& sight,
                      scene::PassageCounter<Real>& counter, Counts& counts) const;
  /// Throws Error (NotClosed) if the options ask for a closed surface and this one is not.
  scene::AxisSpace axis_space(const LocateOptions& options) const;
  /// A default one if no triangle is within the radius.
  NearestPoint<Real> nearest(const Vec3<Real>& point, Real radius, const scene::StopPoll& stop,
                             Counts& counts) const;
};

extern template struct Scene<float>::Impl;
extern template struct Scene<double>::Impl;

}  // namespace pierce
