// SPDX-License-Identifier: Apache-2.0
//
// One case of the campaign: a scene and all that is asked of it. Made from a seed and a number, or
// read back from the file that a difference was saved to.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "campaign/world.h"
#include "pierce/options.h"
#include "pierce/transform.h"
#include "pierce/voxelise.h"

namespace pierce::campaign {

/// Cells to be filled: all layers from `first` on, `layers` of them.
template <class Real>
struct Cells {
  Grid<Real> grid;
  std::uint32_t first = 0, layers = 0;
};

/// One of the source meshes, and where it stands.
template <class Real>
struct Placement {
  std::size_t mesh = 0;
  Transform<Real> transform;
};

/// How the scene comes by its meshes, if not simply by being built from them.
template <class Real>
struct Origin {
  /// The scene is built from these, as many and of the same triangles, and then refitted.
  std::vector<Mesh<Real>> before;
  bool in_place = false;  // by changing them, else by handing over the others
  /// The scene is made of instances of these.
  std::vector<Mesh<Real>> sources;
  std::vector<Placement<Real>> placements;
  bool placed_later = false;  // first all at their origin, then refitted
};

template <class Real>
struct Case {
  std::string name;
  std::vector<Mesh<Real>> meshes;  // what the scene is to see
  Origin<Real> origin;
  std::vector<Quality> qualities;  // the scene is built once for each
  unsigned build_threads = 1;

  std::vector<Ray<Real>> rays;

  // The options of batches, and of every second look at a single ray.
  Range range = Range::Closed;
  std::vector<TriangleRef> skip;  // none, or one a ray
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;
  std::vector<std::uint32_t> ray_masks;       // none, or one a ray in place of `mask`
  std::vector<std::uint32_t> geometry_masks;  // none, or one a geometry
  std::uint64_t max_hits = kUnlimited;

  std::vector<Vec3<Real>> points;
  std::vector<Real> radii;  // one a point
  InsideRule rule = InsideRule::Odd;
  bool open_mesh = false;
  std::optional<Cells<Real>> cells;
};

using AnyCase = std::variant<Case<float>, Case<double>>;

/// The case with this number; the same for the same seed everywhere.
AnyCase make_case(std::uint64_t seed, std::uint64_t number);

/// Numbers are written as hexadecimal floats: nothing is rounded.
void save_case(std::ostream& out, const AnyCase& any);

/// Throws std::runtime_error if the file is not what save_case writes.
AnyCase load_case(std::istream& in);

}  // namespace pierce::campaign
