// SPDX-License-Identifier: Apache-2.0
//
// The ray sets of the benchmark: what a renderer asks (camera, shadow, bounce) and what nobody can
// predict (random chords). A function of the mesh alone: surface points come from exact hits.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pierce/types.h"
#include "workloads/mesh.h"

namespace pierce::bench {

struct RaySet {
  std::string name;
  std::vector<Ray<float>> rays;
  std::vector<Ray<double>> rays_double;  ///< the same numbers
};

/// At most so many rays of the set, evenly spread over it.
[[nodiscard]] RaySet thinned(const RaySet& set, std::size_t most);

/// The place in the set of ray i of `thinned(set, count)`.
[[nodiscard]] inline std::size_t thinned_place(std::size_t i, std::size_t count, std::size_t all) {
  return i * all / count;
}

struct RayKind {
  std::string name, description;
  bool by_default;
};

[[nodiscard]] const std::vector<RayKind>& ray_kinds();

/// Answers closest hits; how a set finds the surface.
using Caster = std::function<void(std::span<const Ray<float>>, std::span<Hit<float>>)>;

/// The ray sets of one mesh. Surface points are found once, when first needed.
class RayMaker {
 public:
  /// Each set has `side` x `side` rays; `side` is a power of two.
  RayMaker(const Mesh& mesh, Caster caster, unsigned side);

  /// Throws Error (InvalidArgument) for a name that ray_kinds() does not list.
  RaySet make(const std::string& name);

 private:
  struct Surface {
    Double3 point, normal;  // just off the surface, on the side it was seen from
  };

  std::vector<Ray<float>> camera(bool by_rows, unsigned pass) const;
  std::vector<Ray<float>> chords() const;
  const std::vector<Surface>& surface();
  Surface surface_at(const Ray<float>& ray, const Hit<float>& hit) const;
  std::size_t count() const { return std::size_t{side_} * side_; }

  const Mesh& mesh_;
  Caster caster_;
  unsigned side_;
  std::vector<Surface> surface_;
};

}  // namespace pierce::bench
