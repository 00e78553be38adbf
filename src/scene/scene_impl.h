// SPDX-License-Identifier: Apache-2.0
//
// What a Scene holds, and how one ray goes through it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bvh/tree.h"
#include "kernels/kernel.h"
#include "pierce/scene.h"
#include "predicate/decide.h"
#include "scene/axis_points.h"
#include "scene/block_query.h"
#include "scene/geometries.h"
#include "scene/hit_collector.h"
#include "scene/passage_counter.h"
#include "scene/placed_meshes.h"
#include "scene/surface.h"

namespace pierce {

template <class Real>
struct Scene<Real>::Impl {
  scene::PlacedMeshes<Real> placed;  // empty unless there are instances
  scene::Geometries<Real> geometries;
  bvh::Tree tree;
  const kernels::Kernel* kernel;
  // Renewed when vertices have moved.
  std::unique_ptr<scene::LazySurface> surface = std::make_unique<scene::LazySurface>();

  /// Everything of a scene; `placed` is what the meshes view.
  static std::unique_ptr<Impl> build(std::span<const MeshView<Real>> meshes,
                                     scene::PlacedMeshes<Real> placed, const BuildOptions& options);
  /// Everything that hangs on positions; if it throws Error, nothing has changed.
  void refit(std::span<const MeshView<Real>> meshes, scene::PlacedMeshes<Real> moved,
             unsigned threads);

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

  Hit<Real> closest(const Ray<Real>& ray, Range range, std::uint32_t skip, Counts& counts) const;
  bool any(const Ray<Real>& ray, Range range, std::uint32_t skip, Counts& counts) const;
  /// The same for the rays of a block; one result a ray.
  void closest(scene::BlockQuery<Real>& query, Hit<Real>* hits, Counts& counts) const;
  void any(scene::BlockQuery<Real>& query, std::uint8_t* hits, Counts& counts) const;
  /// Whether the point lies exactly on some closed triangle other than `skip`.
  bool on_surface(const Vec3<double>& point, std::uint32_t skip) const;
  Crossings crossings(const Ray<Real>& ray, std::uint32_t skip,
                      scene::PassageCounter<Real>& counter, Counts& counts) const;
  /// Throws Error (NotClosed) if the options ask for a closed surface and this one is not.
  scene::AxisSpace axis_space(const LocateOptions& options) const;
  /// A default one if no triangle is within the radius.
  NearestPoint<Real> nearest(const Vec3<Real>& point, Real radius, Counts& counts) const;
  void all(const Ray<Real>& ray, Range range, std::uint32_t skip,
           scene::HitCollector<Real>& collector, std::vector<Hit<Real>>& out, Counts& counts) const;
};

extern template struct Scene<float>::Impl;
extern template struct Scene<double>::Impl;

}  // namespace pierce
