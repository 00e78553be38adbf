// SPDX-License-Identifier: Apache-2.0
//
// Scene: meshes made ready to be asked which triangles a ray pierces.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pierce/arrays.h"
#include "pierce/error.h"
#include "pierce/mesh.h"
#include "pierce/nearest.h"
#include "pierce/options.h"
#include "pierce/scene_file.h"
#include "pierce/transform.h"
#include "pierce/types.h"
#include "pierce/winding.h"

namespace pierce {

template <class Real>
struct Grid;  // pierce/voxelise.h

// Of a library built with hidden symbols, what a program links to is marked: here, and in all
// headers.
template <class Real>
class [[gnu::visibility("default")]] Scene;

/// Figures about a built scene.
struct SceneInfo {
  std::uint64_t triangles = 0;  ///< of all geometries
  std::uint64_t vertices = 0;
  std::uint64_t degenerate = 0;  ///< triangles without area, exactly decided; never hit
  std::uint64_t nodes = 0;       ///< wide nodes of the search tree
  std::uint64_t leaves = 0;      ///< leaf blocks
  double sah_cost = 0;           ///< expected cost of a random ray, in node visits
  std::uint64_t bytes = 0;       ///< memory of the scene beside the caller's meshes
};

/// Thread-safe once built: any number of threads may ask at a time; all but refit leave it as it
/// is. `Real` is float or double; every answer is exact for the numbers given, and every returned
/// number is correctly rounded to Real.
///
/// A ray hits a triangle iff it is not parallel to its plane and meets the closed triangle (edges
/// and vertices belong to it) at a t in its range. A triangle without area is never hit.
///
/// Queries on a single ray throw Error (InvalidRay) if the ray is not valid (see Ray), and
/// (InvalidArgument) if the triangle to skip does not exist; otherwise they do not throw. The
/// closest hit takes 0.1 us in a small scene to 1 us in one that is far larger than the processor's
/// caches, any hit less (docs/performance.md). A query whose options hide sides or geometries is
/// slower, as every hit is looked at in double: 1.2 to 2 times for one ray, three times for a
/// camera's rays.
template <class Real>
class Scene {
 public:
  /// Builds a scene over one mesh (geometry 0) or several (numbered in order). The meshes' arrays
  /// are not copied and must outlive the scene unchanged. Empty meshes are welcome, and so is no
  /// mesh at all. About 0.3 s a million triangles on one core, of which more share the work.
  ///
  /// Throws Error that names the first bad triangle or vertex and how many there are
  /// (IndexOutOfRange, NonFiniteVertex; vertices that no triangle uses may be anything), or
  /// TooManyTriangles, SizeMismatch (masks), Stopped; UnknownKernel if the environment variable
  /// PIERCE_KERNEL asks for an instruction set that this machine has not.
  static Scene build(MeshView<Real> mesh, const BuildOptions& options = {});
  static Scene build(std::span<const MeshView<Real>> meshes, const BuildOptions& options = {});

  /// The same over meshes that the scene takes over and keeps. (An lvalue is viewed by
  /// `build(mesh.view())`, or copied by `build(Mesh(mesh))`.)
  template <std::same_as<Mesh<Real>> Owned>
  static Scene build(Owned&& mesh, const BuildOptions& options = {}) {
    std::vector<Mesh<Real>> meshes;
    meshes.push_back(std::move(mesh));
    return build_owning(std::move(meshes), options);
  }
  template <std::same_as<std::vector<Mesh<Real>>> Owned>
  static Scene build(Owned&& meshes, const BuildOptions& options = {}) {
    return build_owning(std::move(meshes), options);
  }
  /// The same over arrays of any layout: what lies as a MeshView wants it is viewed, and must
  /// outlive the scene unchanged; the rest is copied and kept by the scene. See MeshArrays.
  template <std::same_as<MeshArrays<Real>> Arrays>
  static Scene build(const Arrays& mesh, const BuildOptions& options = {}) {
    return build(std::span<const MeshArrays<Real>>(&mesh, 1), options);
  }
  static Scene build(std::span<const MeshArrays<Real>> meshes, const BuildOptions& options = {});

  /// Builds a scene of meshes in several places (geometry i is instance i). The transformed
  /// vertices are rounded to Real, see Instance, and kept by the scene: a query costs what it costs
  /// without instances, and memory grows with every placement (an identity transform copies
  /// nothing), until that would be more than BuildOptions::flatten_limit: then instances of the
  /// same arrays share one tree, and their vertices are transformed as they are asked for. Throws
  /// Error (NonFiniteVertex) that names the first vertex which is too large once transformed,
  /// (InvalidArgument) if a transform is not finite.
  static Scene build(std::span<const Instance<Real>> instances, const BuildOptions& options = {});

  /// Writes the scene to a file, which appears under its name when it is complete: the search tree,
  /// the meshes (instances as they are placed), masks, and the names of the geometries. Every
  /// machine writes the same bytes. About 1 s a GB and the disk's time. Throws Error (BadFile) if
  /// it cannot be written, (SizeMismatch) unless there are no names or one a geometry, (Stopped),
  /// (InvalidArgument) if instances share trees (BuildOptions::flatten_limit).
  void save(const std::string& path, const SaveOptions& options = {}) const;

  /// Opens what `save` wrote, by any machine: a scene that answers as the one that was saved, to
  /// the bit. The file is memory: pages come in as queries look at them, and all processes that
  /// have it open share them; the look at the tree takes about 2 ms a million triangles on one
  /// core. It must not be written to while scenes are open (replacing it by another, as `save`
  /// does, is harmless).
  ///
  /// Throws Error (BadFile), one line with the cure: no scene file, cut short, damaged, of numbers
  /// of the other type, of a newer version. See LoadOptions for what is looked at when; a query
  /// that meets damage that the load did not throws that, too.
  static Scene load(const std::string& path, const LoadOptions& options = {});

  /// The meshes as they are asked about, geometry by geometry: those that the scene was built from
  /// (instances as placed), or those of its file. Good for as long as the scene is neither refitted
  /// nor destroyed. (Of a file that was not verified, indices may be anything.)
  [[nodiscard]] std::span<const MeshView<Real>> meshes() const;

  /// Makes the scene anew for vertices that have moved: the caller's arrays, changed in place
  /// since, or other meshes with as many triangles each as those the scene was built from; they
  /// must outlive it like those. Every answer is then as exact as a new scene's and the same to the
  /// bit. The search tree keeps its structure and fits its boxes to the triangles, which takes a
  /// third of a build or less; queries slow down as triangles part that were neighbours when it was
  /// built, and once info().sah_cost has doubled, a tree is built anew, in the time of a build.
  ///
  /// Throws Error: SizeMismatch, or what build throws about a bad vertex. The scene is then as it
  /// was, and so is every answer once the arrays it views are. Not for calling while another thread
  /// asks. `threads` 0: as many as the machine has.
  void refit(const WorkOptions& work = {});
  void refit(MeshView<Real> mesh, const WorkOptions& work = {});
  void refit(std::span<const MeshView<Real>> meshes, const WorkOptions& work = {});
  /// The same for instances that have moved. (Without instances or meshes, those that the scene has
  /// are looked at again.)
  void refit(std::span<const Instance<Real>> instances, const WorkOptions& work = {});

  /// The same for meshes that the scene takes over, and for arrays of any layout. (Without meshes,
  /// arrays that were copied are copied again.)
  template <std::same_as<Mesh<Real>> Owned>
  void refit(Owned&& mesh, const WorkOptions& work = {}) {
    std::vector<Mesh<Real>> meshes;
    meshes.push_back(std::move(mesh));
    refit_owning(std::move(meshes), work);
  }
  template <std::same_as<std::vector<Mesh<Real>>> Owned>
  void refit(Owned&& meshes, const WorkOptions& work = {}) {
    refit_owning(std::move(meshes), work);
  }
  template <std::same_as<MeshArrays<Real>> Arrays>
  void refit(const Arrays& mesh, const WorkOptions& work = {}) {
    refit(std::span<const MeshArrays<Real>>(&mesh, 1), work);
  }
  void refit(std::span<const MeshArrays<Real>> meshes, const WorkOptions& work = {});

  /// May be moved, not copied. One that has been moved from may only be assigned to or destroyed.
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  /// The hit with the smallest exact t; of equal t, the smallest (geometry, triangle). Without
  /// options, as with the default ones (a few nanoseconds sooner: these need not be made).
  [[nodiscard]] std::optional<Hit<Real>> closest_hit(const Ray<Real>& ray) const;
  [[nodiscard]] std::optional<Hit<Real>> closest_hit(const Ray<Real>& ray,
                                                     const QueryOptions& options) const;

  /// Whether the ray hits any triangle.
  [[nodiscard]] bool any_hit(const Ray<Real>& ray) const;
  [[nodiscard]] bool any_hit(const Ray<Real>& ray, const QueryOptions& options) const;

  /// Every hit, or the first `max_hits`, ordered by (exact t, geometry, triangle); replaces what
  /// `out` held. Each hit is decided, but only those that are returned are rounded.
  void all_hits(const Ray<Real>& ray, std::vector<Hit<Real>>& out,
                const QueryOptions& options = {}) const;

  /// How many hits all_hits has without `max_hits`, which means nothing here. Nothing is put in
  /// order or rounded.
  [[nodiscard]] std::uint32_t count_hits(const Ray<Real>& ray,
                                         const QueryOptions& options = {}) const;

  /// How often the ray passes through the surface, each passage counted once, be it through a face,
  /// an edge or a vertex (see Crossings). Triangles parallel to the ray count 0. With `sides`, both
  /// counts are of passages of that kind alone: Front enters, Back leaves. Triangles that the ray
  /// does not see are no surface, under its origin neither; an origin on a triangle is on the
  /// surface whatever `sides` says.
  [[nodiscard]] Crossings crossings(const Ray<Real>& ray, const QueryOptions& options = {}) const;

  /// Where to start the next ray from a hit of this one, without an epsilon: a point next to the
  /// hit point, strictly on the wanted side of the hit triangle's plane, and in the very region of
  /// space that the ray was in just before the hit (Side::Before), or is in just beyond it
  /// (Beyond). No triangle lies between: the way from the start straight to the ray's own points,
  /// as near to the hit as one likes, meets none, also at edges and vertices. So on a closed mesh
  /// nothing leaks: the start is Inside if the ray was. As a rule it is within two units in the
  /// last place of the hit point's largest coordinate; in narrow corners it is as much farther as
  /// it has to be. (At an edge or a vertex that a ray grazes, the region may have no number of Real
  /// on that side of the plane; then a point of the region is good enough.)
  ///
  /// Nothing if there is no such point: the ray runs along a triangle there, or the space is too
  /// narrow for the numbers of Real. (Before the first hit of a ray that starts off the surface
  /// and runs along none there always is one, the ray's origin.) `hit` is an answer of this scene
  /// to the ray; throws Error (InvalidArgument) if the ray's line does not hit that triangle. About
  /// 2 us, more at edges.
  [[nodiscard]] std::optional<Vec3<Real>> next_origin(const Ray<Real>& ray, const Hit<Real>& hit,
                                                      Side side) const;

  /// The same for every ray and its hit, on threads; nothing where the hit is a miss. Throws naming
  /// the first ray whose line does not hit the triangle of its hit. Of the options, those of the
  /// ray's question mean nothing: all triangles are in the way.
  void next_origins(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits, Side side,
                    std::span<std::optional<Vec3<Real>>> origins,
                    const BatchOptions& options = {}) const;

  /// The exact point o + t d of a hit, each coordinate rounded once (zero is +0). So it need not
  /// lie exactly on the ray, nor on the triangle: to start another ray from, ask next_origin. Any
  /// triangle will do that the ray's line hits, in its range or not; else Error (InvalidArgument).
  /// About 0.1 us.
  [[nodiscard]] Vec3<Real> hit_point(const Ray<Real>& ray, const TriangleRef& hit) const;
  /// The same for every ray and its hit, on threads; NaN in each coordinate where the hit is a
  /// miss, whatever the ray. Throws naming the first ray whose line does not hit the triangle of
  /// its hit.
  void hit_points(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits,
                  std::span<Vec3<Real>> points, const WorkOptions& work = {}) const;

  /// N = (b - a) x (c - a) of a triangle: each component rounded once, infinite where it is too
  /// large for Real, +0 where it is zero. Throws Error (InvalidArgument) if there is no such
  /// triangle.
  [[nodiscard]] Vec3<Real> normal(const TriangleRef& triangle) const;
  /// N / |N|, each component rounded once; (0, 0, 0) for a triangle without area. (Its length is 1
  /// but for these roundings.)
  [[nodiscard]] Vec3<Real> unit_normal(const TriangleRef& triangle) const;
  /// The same for many, on threads; NaN for a miss, or a TriangleRef that names none.
  void normals(std::span<const TriangleRef> triangles, std::span<Vec3<Real>> normals,
               const WorkOptions& work = {}) const;
  void normals(std::span<const Hit<Real>> hits, std::span<Vec3<Real>> normals,
               const WorkOptions& work = {}) const;
  void unit_normals(std::span<const TriangleRef> triangles, std::span<Vec3<Real>> normals,
                    const WorkOptions& work = {}) const;
  void unit_normals(std::span<const Hit<Real>> hits, std::span<Vec3<Real>> normals,
                    const WorkOptions& work = {}) const;

  /// Which of two triangles the ray hits first, in the order of all_hits: (exact t, geometry,
  /// triangle). Both may be out of its range; throws Error (InvalidArgument) if its line does not
  /// hit one of them.
  [[nodiscard]] std::strong_ordering compare_hits(const Ray<Real>& ray, const TriangleRef& first,
                                                  const TriangleRef& second) const;

  /// Batches: the fast way, on as many threads as the options say. One output per ray, in the order
  /// of the rays, with the answers of the queries above bit by bit. The query about one ray has a
  /// name in the singular, its batch the same in the plural (closest_hit, closest_hits); where the
  /// name is a plural or a verb already (all_hits, locate), both have it.
  ///
  /// Rays come as an array of Ray or as RayArrays, answers go to an array or to columns of any
  /// layout, see pierce/arrays.h: both ways are the same and cost the same.
  ///
  /// Throws Error (SizeMismatch) unless outputs and rays are equally many, (InvalidArgument,
  /// InvalidRay) that names the first bad option or ray and how many there are, (Stopped) if the
  /// caller has it stop. Rays are looked at block by block as they come: when a batch throws, its
  /// outputs and statistics are unspecified, and its progress may have moved.
  ///
  /// closest_hits: a miss is a default Hit. any_hits: 1 for a hit, 0 for none.
  void closest_hits(std::span<const Ray<Real>> rays, std::span<Hit<Real>> hits,
                    const BatchOptions& options = {}) const;
  void closest_hits(const RayArrays<Real>& rays, const HitArrays<Real>& hits,
                    const BatchOptions& options = {}) const;
  void any_hits(std::span<const Ray<Real>> rays, std::span<std::uint8_t> hits,
                const BatchOptions& options = {}) const;
  void any_hits(const RayArrays<Real>& rays, const Rows<std::uint8_t>& hits,
                const BatchOptions& options = {}) const;
  /// The hits of all rays in one table; see HitLists. It takes 28 bytes a hit, 48 in double.
  [[nodiscard]] HitLists<Real> all_hits(std::span<const Ray<Real>> rays,
                                        const BatchOptions& options = {}) const;
  /// The same lists in pieces, in the order of the rays, so that memory does not grow with their
  /// number: `consume(first, lists)` is handed the lists of the rays first, first + 1, ..., at
  /// least one and at most 1,024 of them, and fewer than 65,536 hits beside those of the last ray.
  /// No more than eight such pieces a thread are kept at a time. Called from the calling thread;
  /// what it throws ends the batch and reaches the caller.
  void all_hits(std::span<const Ray<Real>> rays, const BatchOptions& options,
                const HitListsConsumer<Real>& consume) const;
  [[nodiscard]] HitLists<Real> all_hits(const RayArrays<Real>& rays,
                                        const BatchOptions& options = {}) const;
  void all_hits(const RayArrays<Real>& rays, const BatchOptions& options,
                const HitListsConsumer<Real>& consume) const;
  /// The same pieces, written into columns that `room` provides for each, see HitRoom.
  void all_hits(const RayArrays<Real>& rays, const BatchOptions& options,
                const HitRoom<Real>& room) const;
  void count_hits(std::span<const Ray<Real>> rays, std::span<std::uint32_t> counts,
                  const BatchOptions& options = {}) const;
  void count_hits(const RayArrays<Real>& rays, const Rows<std::uint32_t>& counts,
                  const BatchOptions& options = {}) const;
  /// `options.range` means nothing here: no passage is exactly at an end of the range.
  void crossings(std::span<const Ray<Real>> rays, std::span<Crossings> results,
                 const BatchOptions& options = {}) const;
  void crossings(const RayArrays<Real>& rays, const CrossingsArrays& results,
                 const BatchOptions& options = {}) const;

  /// Where the point lies with respect to the surface, all geometries of the scene together:
  /// OnSurface if it lies exactly on some triangle (edges, vertices and triangles without area
  /// included), else Inside or Outside by the rule. Throws Error (NotClosed), naming the first open
  /// edge, unless every edge, by position, is used an even number of times (InsideRule::Odd,
  /// Unique) or as often one way as the other (NonZero); a T-junction is no gap, see Closedness.
  /// Winding asks nothing of it. Whether that is so is found out once, by the first call: about 0.1
  /// s a million triangles. Throws Error (InvalidPoint) if the point is not finite.
  [[nodiscard]] Location locate(const Vec3<Real>& point, const LocateOptions& options = {}) const;
  /// Many points are faster together: they are sorted and looked at sixteen at a time.
  void locate(std::span<const Vec3<Real>> points, std::span<Location> locations,
              const LocateOptions& options = {}) const;
  /// Points in arrays of any layout, three components each; answers as in Location: -1 Outside, 0
  /// OnSurface, 1 Inside.
  void locate(const Rows<const Real>& points, const Rows<std::int8_t>& locations,
              const LocateOptions& options = {}) const;
  /// How often the surface winds around the point, with a bound on the error: at most
  /// `options.tolerance`, see there. A microsecond or two in a scene with few open edges, the more
  /// the more there are. The first call prepares the open edges. Throws Error (InvalidPoint) if the
  /// point is not finite, (InvalidArgument) if the tolerance is negative or NaN, or if instances
  /// share trees (BuildOptions::flatten_limit).
  [[nodiscard]] WindingNumber winding_number(const Vec3<Real>& point,
                                             const WindingOptions& options = {}) const;
  void winding_numbers(std::span<const Vec3<Real>> points, std::span<WindingNumber> numbers,
                       const WindingOptions& options = {}) const;
  /// The same with arrays of any layout. `errors` may be left out.
  void winding_numbers(const Rows<const Real>& points, const Rows<double>& values,
                       const Rows<double>& errors, const WindingOptions& options = {}) const;

  /// The cells (i, j, k) of a grid with first <= i < first + layers, one result each, k fastest;
  /// see pierce/voxelise.h, and there voxelise for the whole grid.
  void voxelise(const Grid<Real>& grid, std::uint32_t first, std::uint32_t layers,
                std::span<Location> cells, const LocateOptions& options = {}) const;

  /// The point of the surface that is nearest to `point`, edges, vertices and triangles without
  /// area included, and of equally near triangles the smallest (geometry, triangle). Nothing if no
  /// triangle is within `radius`; one exactly that far away is. Throws Error (InvalidPoint) if the
  /// point is not finite, (InvalidArgument) if the radius is negative or NaN. About 1 us.
  [[nodiscard]] std::optional<NearestPoint<Real>> nearest_point(
      const Vec3<Real>& point, Real radius = kInfinity<Real>) const;
  /// One answer a point; a default NearestPoint if there is none.
  void nearest_points(std::span<const Vec3<Real>> points, std::span<NearestPoint<Real>> nearest,
                      const NearestOptions<Real>& options = {}) const;
  void nearest_points(const Rows<const Real>& points, const NearestArrays<Real>& nearest,
                      const NearestOptions<Real>& options = {}) const;

  /// The triangles that are nearest to `point`, at most `most` of them and none farther away than
  /// `radius`, ordered by (exact distance, geometry, triangle); replaces what `out` held. With
  /// kUnlimited these are all triangles within the radius. Throws what nearest_point throws.
  void nearest_triangles(const Vec3<Real>& point, std::uint64_t most,
                         std::vector<NearestPoint<Real>>& out, Real radius = kInfinity<Real>) const;

  /// The triangles that have a point in common with the closed segment from `from` to `to` (which
  /// may be the same point), decided exactly: touching counts, triangles without area and those in
  /// line with the segment as well. Ordered by (geometry, triangle); replaces what `out` held.
  /// Throws Error (InvalidPoint) if an end is not finite.
  void touching_segment(const Vec3<Real>& from, const Vec3<Real>& to,
                        std::vector<TriangleRef>& out) const;
  /// The same for the closed box from `lower` to `upper`. One whose lower end is above its upper
  /// one holds nothing. Throws Error (InvalidPoint) if a corner is not finite.
  void touching_box(const Vec3<Real>& lower, const Vec3<Real>& upper,
                    std::vector<TriangleRef>& out) const;

  /// The distance to the surface, correctly rounded, negative where the point is Inside; 0 on the
  /// surface, infinite in a scene without triangles. One that is too small for Real is 0 on either
  /// side: ask `locate`. Throws what `locate` throws.
  [[nodiscard]] Real signed_distance(const Vec3<Real>& point,
                                     const LocateOptions& options = {}) const;
  /// Each point counts twice in the statistics: it is located, and its nearest point is looked for.
  void signed_distances(std::span<const Vec3<Real>> points, std::span<Real> distances,
                        const LocateOptions& options = {}) const;
  void signed_distances(const Rows<const Real>& points, const Rows<Real>& distances,
                        const LocateOptions& options = {}) const;

  /// Counts anew which triangles have no area, exactly: about 0.3 s a million triangles.
  [[nodiscard]] SceneInfo info() const;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  static Scene build_owning(std::vector<Mesh<Real>> meshes, const BuildOptions& options);
  void refit_owning(std::vector<Mesh<Real>> meshes, const WorkOptions& work);
  std::unique_ptr<Impl> impl_;
};

extern template class Scene<float>;
extern template class Scene<double>;

}  // namespace pierce
