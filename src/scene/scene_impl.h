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
#include "scene/rays/two_level_query.h"
#include "scene/two_level.h"
#include "support/lock.h"
#include "support/private_mapping.h"

namespace pierce::scene {
template <class Real>
class ListCollector;
}

namespace pierce {

template <class Real>
struct Scene<Real>::Impl {
  std::shared_ptr<const PrivateMapping> file;  // what tree and meshes lie in, if they do
  scene::PlacedMeshes<Real> placed;            // empty unless there are instances
  scene::Geometries<Real> geometries;
  // If instances share trees (`tree` is then empty), or parts are too fine for the scene's space
  // (`tree` is then for points).
  std::unique_ptr<scene::TwoLevel<Real>> two_level;
  bvh::Tree tree;
  Quality quality;
  double built_cost;  // the tree's sah_cost when its structure was made
  const kernels::Kernel* kernel;
  // The scene without triangles that repeat others, for InsideRule::Unique.
  struct LazyUnique {
    parallel::Once made;
    scene::Unrepeated<Real> parts;
    std::unique_ptr<Impl> scene;  // none if no triangle repeats another
  };
  // Both are renewed when vertices have moved.
  std::unique_ptr<scene::LazySurface> surface = std::make_unique<scene::LazySurface>();
  std::unique_ptr<LazyUnique> unique = std::make_unique<LazyUnique>();
  std::unique_ptr<scene::LazyFill<Real>> fill = std::make_unique<scene::LazyFill<Real>>();

  /// Everything of a scene; `placed` is what the meshes view.
  static std::unique_ptr<Impl> build(std::span<const MeshView<Real>> meshes,
                                     scene::PlacedMeshes<Real> placed, const BuildOptions& options);
  /// The same of instances: flat, or in two levels.
  static std::unique_ptr<Impl> build(std::span<const Instance<Real>> instances,
                                     const BuildOptions& options);
  /// Of instances in two levels; null if these are no good for them.
  static std::unique_ptr<Impl> share(std::span<const Instance<Real>> instances,
                                     const BuildOptions& options);
  /// Gives parts that need it spaces of their own.
  void part(const WorkOptions& work);
  /// Everything that hangs on positions; if it throws Error, nothing has changed.
  void refit(std::span<const MeshView<Real>> meshes, scene::PlacedMeshes<Real> moved,
             const WorkOptions& work);
  /// The same of instances in two levels.
  void place_anew(std::span<const Instance<Real>> instances, const WorkOptions& work);
  void become(std::unique_ptr<Impl> other);
  /// As it was built, by this work. (The masks are viewed.)
  [[nodiscard]] BuildOptions options_of(const WorkOptions& work) const;
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
    scene::tell_all(*kernel, tree, two_level.get(), geometries, predicate::to_double(ray, range),
                    sight, filter_ray, sink, counts.kernel_counts());
    return true;
  }
  /// Calls `visit(primitive)` for every triangle that may meet the box, in filter space, until it
  /// returns true; returns whether it did. A triangle may be visited twice.
  template <class Visit>
  bool traverse_box(const Vec3<double>& lower, const Vec3<double>& upper,
                    const Visit& visit) const {
    return geometries.shares_meshes() ? two_level->traverse_box(lower, upper, visit)
                                      : bvh::traverse_box(tree, lower, upper, visit);
  }
  /// The same for every triangle in boxes, in filter space, of which `may_meet(box)` is true.
  template <class MayMeet, class Visit>
  void traverse_where(const MayMeet& may_meet, const Visit& visit) const {
    if (geometries.shares_meshes()) {
      two_level->traverse_where(may_meet, visit);
      return;
    }
    const auto holds = [&](const bvh::Node& node, int child) {
      return may_meet(scene::middle_box(node, child));
    };
    bvh::traverse_where(tree, holds, [&](std::uint32_t primitive) {
      visit(primitive);
      return false;
    });
  }
  /// Appends the first hits, `most` at most.
  void all(const Ray<Real>& ray, Range range, const scene::Sight& sight, std::uint64_t most,
           scene::ListCollector<Real>& collector, std::vector<Hit<Real>>& out,
           Counts& counts) const;
  /// The same of hits that are counted one by one.
  void all(const scene::Asked<Real>& asked, std::uint64_t number, std::uint64_t most,
           scene::CountedHits<Real>& counted, std::vector<Hit<Real>>& out, Counts& counts) const;
  std::uint32_t count(const Ray<Real>& ray, Range range, const scene::Sight& sight,
                      scene::HitCounter<Real>& counter, Counts& counts) const;
  /// Whether the point lies exactly on some closed triangle of those that are seen.
  bool on_surface(const Vec3<double>& point, const scene::Sight& sight) const;
  Crossings crossings(const Ray<Real>& ray, const scene::Sight& sight,
                      scene::PassageCounter<Real>& counter, Counts& counts) const;
  /// The scene that knows what is inside under these options: this one, or the one of its `unique`.
  /// Throws Error (NotClosed) if they ask for a closed surface and that one is not.
  const Impl& asked(const LocateOptions& options) const;
  scene::AxisSpace axis_space() const;
  /// Throws Error (InvalidArgument) if instances share trees, which `what` cannot do with.
  void require_flat(const char* what) const;
  /// Where a point lies, by the passages of one ray: for two levels. By the rule of the options;
  /// nothing is looked at of whether the surface is closed.
  Location locate_by_ray(const Vec3<Real>& point, const LocateOptions& options,
                         scene::PassageCounter<Real>& counter, Counts& counts) const;
  /// A default one if no triangle is within the radius.
  NearestPoint<Real> nearest(const Vec3<Real>& point, Real radius, const scene::StopPoll& stop,
                             Counts& counts) const;
};

extern template struct Scene<float>::Impl;
extern template struct Scene<double>::Impl;

}  // namespace pierce
