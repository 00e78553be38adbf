// SPDX-License-Identifier: Apache-2.0
//
// A Scene as the Python package sees it: arrays in and out, locked against changes while asked.
// `bindings/python/pierce/_scene.py` is the only caller; it has made sure of types and shapes.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "buffer.h"
#include "pierce/pierce.h"
#include "run.h"
#include "scene_lock.h"

namespace pierce::python {

/// Of scenes and what updates make of them, each has a number of its own, from 1.
constexpr std::uint64_t kAnyVersion = 0;
[[nodiscard]] std::uint64_t next_version();

/// What is asked of rays beyond the rays: BatchOptions, in Python's types.
struct Question {
  bool open_start = false;
  int sides = 0;  ///< as Sides has them
  bool distinct = false;
  bool invalid_miss = false;
  std::uint64_t max_hits = kUnlimited;
  std::uint64_t version = kAnyVersion;  ///< of the scene that must answer; or RuntimeError
  std::uint32_t mask = kAllBits;
  nb::object masks = nb::none();  ///< None or (n,) uint32
  nb::object skip = nb::none();   ///< None or (n, 2) uint32: geometry, triangle
  nb::object after = nb::none();  ///< likewise
  Control control;
};

/// What is asked of points.
struct PointQuestion {
  std::uint8_t rule = 0;  ///< an InsideRule
  bool open_mesh = false;
  Control control;
};

/// (origins (n or 1, 3), directions (n or 1, 3), t_min None or (n or 1,), t_max likewise), n > 0;
/// or (table,), (n, 6 or 8): origin, direction, and t_min and t_max.
using RayTuple = nb::tuple;

template <class Real>
class SceneOf {
 public:
  /// `meshes`: a list of (vertices (v, 3) Real, triangles (t, 3) uint32, None or a (3, 4) Real
  /// map), packed, which are kept and must not change. `masks`: None or (m,) uint32.
  SceneOf(const nb::list& meshes, int quality, nb::handle masks, std::uint64_t flatten_limit,
          const Control& control);
  /// A scene file; the paths of both come as the bytes that the file system knows.
  SceneOf(const nb::bytes& path, bool verify, const Control& control);
  /// `known` is what Python knows of them. Either all of it happens, `version` too, or nothing.
  void refit(const nb::list& meshes, nb::object known, const Control& control);
  /// `names`: a list of str, one a geometry.
  void save(const nb::bytes& path, const nb::list& names, const Control& control);

  /// `columns`: (t, u, v, w, geometry, triangle, facing, point, unit normal), each an array to be
  /// filled or None.
  /// Returns the version of the scene that answered.
  std::uint64_t closest_hits(const RayTuple& rays, const nb::tuple& columns,
                             const Question& question);
  /// (all columns but the last two, a new bytearray (PackedColumns); the version).
  nb::tuple closest_packed(const RayTuple& rays, const Question& question);
  void any_hits(const RayTuple& rays, nb::handle hits, const Question& question);
  void count_hits(const RayTuple& rays, nb::handle counts, const Question& question);
  /// `columns`: (count, signed_count, origin_on_surface).
  void crossings(const RayTuple& rays, const nb::tuple& columns, const Question& question);
  /// Fills `offsets`, (n + 1,) int64; returns the columns as new arrays, in the order above, or, of
  /// few hits, a bytearray of them (PackedColumns); and the version.
  nb::tuple all_hits(const RayTuple& rays, nb::handle offsets, const Question& question);

  /// `hits`: (n, 2) uint32, as in Question::skip; `version` likewise. `points` (n, 3) is filled.
  void hit_points(const RayTuple& rays, nb::handle hits, nb::handle points, std::uint64_t version,
                  const Control& control);
  void next_origins(const RayTuple& rays, nb::handle hits, bool beyond, nb::handle points,
                    std::uint64_t version, const Control& control);
  void normals(nb::handle hits, bool unit, nb::handle normals, std::uint64_t version,
               const Control& control);

  void locate(nb::handle points, nb::handle locations, const PointQuestion& question);
  void signed_distances(nb::handle points, nb::handle distances, const PointQuestion& question);
  void winding_numbers(nb::handle points, nb::handle numbers, nb::handle errors, double tolerance,
                       const Control& control);
  /// `columns`: (point (n, 3), distance, u, v, w, geometry, triangle, feature).
  void nearest_points(nb::handle points, nb::handle radii, const nb::tuple& columns,
                      const Control& control);
  nb::object nearest_packed(nb::handle points, nb::handle radii, const Control& control);
  /// Fills `offsets`, (n + 1,) int64; returns the columns of nearest_points as new arrays. `radii`:
  /// (1,) or (n,).
  nb::tuple nearest_triangles(nb::handle points, std::uint64_t most, nb::handle radii,
                              nb::handle offsets, const Control& control);
  /// Fill `offsets`, (n + 1,) int64; return (geometry, triangle).
  nb::tuple touching_segments(nb::handle starts, nb::handle ends, nb::handle offsets,
                              const Control& control);
  nb::tuple touching_boxes(nb::handle lower, nb::handle upper, nb::handle offsets,
                           const Control& control);
  /// `grid`: the three numbers of the origin, then of the spacing, (6,) Real.
  void voxelise(nb::handle grid, std::uint32_t x, std::uint32_t y, std::uint32_t z,
                nb::handle cells, const PointQuestion& question);

  nb::dict info();

  [[nodiscard]] nb::object known() const { return known_; }
  void set_known(nb::object known) { known_ = std::move(known); }
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Until it ends, the scene is not changed: for who asks several times and calls Python between.
  class Hold;

  /// In a forked child, where the threads that were asking or changing the scene are not.
  void forget_threads() {
    if (lock_.forget_threads()) half_changed_ = true;
  }

 private:
  // While one of these lives, the scene is not changed. Ends with KeyboardInterrupt if it must.
  class Asking;
  class Changing;
  struct Meshes;

  // How far a ray goes: to the first hit, or through everything, which takes longer a triangle.
  enum class Reach : std::uint8_t { First, All };
  [[nodiscard]] Length length(std::size_t count, Reach reach = Reach::First) const;

  void nearest(const Rows<const Real>& points, nb::handle radii, const NearestArrays<Real>& results,
               const Control& control);

  // All of these change together, under the lock and the GIL.
  std::optional<Meshes> meshes_;
  nb::object known_ = nb::none();
  std::uint64_t version_ = next_version();

  std::optional<Scene<Real>> scene_;
  std::uint64_t triangles_ = 0;
  bool half_changed_ = false;  ///< forked in the middle of a change
  SceneLock lock_;
};

/// The meshes that a scene looks at, kept.
template <class Real>
struct SceneOf<Real>::Meshes {
  explicit Meshes(const nb::list& list);

  std::vector<Buffer> buffers;
  std::vector<MeshView<Real>> views;
  std::vector<Instance<Real>> instances;  ///< one for each view, if any of them has a map
  std::uint64_t triangles = 0;
};

/// The rays of a call, kept while it lasts.
template <class Real>
class RaysOf {
 public:
  explicit RaysOf(const RayTuple& rays) {
    if (rays.size() == 1) {
      origins_ = Buffer(rays[0], "rays");
      return;
    }
    origins_ = Buffer(rays[0], "origins");
    directions_ = Buffer(rays[1], "directions");
    t_min_ = Buffer(rays[2], "t_min");
    t_max_ = Buffer(rays[3], "t_max");
  }

  [[nodiscard]] RayArrays<Real> get() const {
    if (!directions_.given()) return from_table();
    return {origins_.rows<const Real>(3), directions_.rows<const Real>(3),
            t_min_.rows<const Real>(), t_max_.rows<const Real>()};
  }

 private:
  [[nodiscard]] RayArrays<Real> from_table() const {
    const bool ranges = origins_.columns() == 8;
    const Rows<const Real> table = origins_.rows<const Real>(ranges ? 8 : 6);
    const auto from = [&](int column) {
      Rows<const Real> rows = table;
      rows.data = reinterpret_cast<const Real*>(reinterpret_cast<const std::byte*>(table.data) +
                                                column * table.step);
      return rows;
    };
    RayArrays<Real> rays{table, from(3), {}, {}};
    if (ranges) {
      rays.t_min = from(6);
      rays.t_max = from(7);
    }
    return rays;
  }

  Buffer origins_, directions_, t_min_, t_max_;
};

/// Columns of hits, as closest_hits has them.
template <class Real>
class HitColumns {
 public:
  explicit HitColumns(const nb::tuple& columns);
  [[nodiscard]] HitArrays<Real> get() const {
    return {.t = at_[0].rows<Real>(),
            .u = at_[1].rows<Real>(),
            .v = at_[2].rows<Real>(),
            .w = at_[3].rows<Real>(),
            .geometry = at_[4].rows<std::int64_t>(),
            .triangle = at_[5].rows<std::int64_t>(),
            .facing = at_[6].rows<std::uint8_t>(),
            .point = at_[7].rows<Real>(3),
            .unit_normal = at_[8].rows<Real>(3)};
  }

 private:
  std::vector<Buffer> at_;
};

template <class Real>
SceneOf<Real>::Meshes::Meshes(const nb::list& list) {
  bool placed = false;
  for (nb::handle item : list) {
    const nb::tuple mesh = nb::cast<nb::tuple>(item);
    Buffer vertices(mesh[0], "vertices"), corners(mesh[1], "triangles"), map(mesh[2], "transform");
    const auto view = MeshView<Real>{vertices.packed<const Vec3<Real>, const Real>(3),
                                     corners.packed<const Triangle, const std::uint32_t>(3)};
    views.push_back(view);
    triangles += view.triangles.size();
    Instance<Real> instance{view};
    if (map.given()) {
      const auto rows = map.packed<const std::array<Real, 4>, const Real>(4);
      if (rows.size() != 3) throw nb::value_error("transform has another shape than expected");
      std::copy(rows.begin(), rows.end(), instance.transform.rows.begin());
      placed = true;
    }
    instances.push_back(instance);
    buffers.push_back(std::move(vertices));
    buffers.push_back(std::move(corners));
  }
  if (!placed) instances.clear();
}

/// The scenes that this thread is asking, or changing: to notice when a callback would wait for
/// itself.
[[nodiscard]] std::vector<const void*>& asked_in_this_thread();
[[nodiscard]] std::vector<const void*>& changed_in_this_thread();

inline void refuse_if_among(const std::vector<const void*>& scenes, const void* scene,
                            const char* why) {
  if (std::find(scenes.begin(), scenes.end(), scene) != scenes.end()) throw std::runtime_error(why);
}

inline void refuse_if_half_changed(bool half_changed) {
  if (!half_changed) return;
  throw std::runtime_error(
      "this process was forked while another thread was in update(); make the scene anew");
}

/// Waits for the lock without the GIL; Ctrl-C ends the waiting.
template <class TryFor>
void wait_for_lock(const TryFor& try_for) {
  while (!try_for(SceneLock::Time(0))) {
    {
      const nb::gil_scoped_release released;
      if (try_for(SceneLock::Time(40))) return;
    }
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
}

template <class Real>
class SceneOf<Real>::Asking {
 public:
  explicit Asking(SceneOf& scene, std::uint64_t version = kAnyVersion) : scene_(scene) {
    refuse_if_half_changed(scene.half_changed_);
    refuse_if_among(changed_in_this_thread(), &scene,
                    "the progress of update() asked the scene that is being updated; ask it "
                    "afterwards");
    auto& asked = asked_in_this_thread();
    const bool again = std::find(asked.begin(), asked.end(), &scene) != asked.end();
    wait_for_lock([&](auto time) { return scene.lock_.share_within(time, again); });
    forks_ = scene.lock_.forks();
    if (version != kAnyVersion && version != scene.version_) {
      scene.lock_.end_sharing(forks_);
      throw std::runtime_error("the scene was updated since; ask it again");
    }
    asked.push_back(&scene_);
  }
  ~Asking() {
    auto& asked = asked_in_this_thread();  // the last one there, unless a Hold ended out of turn
    const auto last = std::find(asked.rbegin(), asked.rend(), &scene_);
    if (last != asked.rend()) asked.erase(std::next(last).base());
    scene_.lock_.end_sharing(forks_);
  }
  Asking(const Asking&) = delete;
  const Scene<Real>* operator->() const { return &*scene_.scene_; }

 private:
  SceneOf& scene_;
  unsigned forks_ = 0;
};

template <class Real>
class SceneOf<Real>::Hold {
 public:
  explicit Hold(SceneOf& scene) : scene_(scene) {}
  void begin() { asking_ = std::make_unique<Asking>(scene_); }
  void end() { asking_.reset(); }
  [[nodiscard]] std::uint64_t version() const { return scene_.version_; }

 private:
  SceneOf& scene_;
  std::unique_ptr<Asking> asking_;
};

template <class Real>
class SceneOf<Real>::Changing {
 public:
  explicit Changing(SceneOf& scene) : scene_(scene) {
    refuse_if_half_changed(scene.half_changed_);
    constexpr const char* kWhy =
        "update() was called by a callback of a call on the same scene; call it afterwards";
    refuse_if_among(asked_in_this_thread(), &scene, kWhy);
    refuse_if_among(changed_in_this_thread(), &scene, kWhy);
    const Wish wish(scene);
    wait_for_lock([&](auto time) { return scene.lock_.own_within(time); });
    forks_ = scene.lock_.forks();
    changed_in_this_thread().push_back(&scene_);
  }
  ~Changing() {
    changed_in_this_thread().pop_back();
    scene_.lock_.end_owning(forks_);
  }
  Changing(const Changing&) = delete;

 private:
  struct Wish {
    explicit Wish(SceneOf& scene) : lock(scene.lock_) { lock.wish_to_own(); }
    ~Wish() { lock.end_wishing(); }
    Wish(const Wish&) = delete;
    SceneLock& lock;
  };

  SceneOf& scene_;
  unsigned forks_ = 0;
};

// Brief is what ends within 0.1 s or so however the rays lie, even if each meets every triangle.
template <class Real>
Length SceneOf<Real>::length(std::size_t count, Reach reach) const {
  if (count > 2048) return Length::Long;
  const std::uint64_t most = reach == Reach::First ? 4'000'000 : 400'000;
  return count * triangles_ <= most ? Length::Brief : Length::Long;
}

}  // namespace pierce::python
