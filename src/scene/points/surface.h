// SPDX-License-Identifier: Apache-2.0
//
// What questions of inside and outside ask of a scene as a whole: is its surface closed? Found out
// once, by whoever asks first.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "bvh/tree.h"
#include "pierce/error.h"
#include "pierce/options.h"
#include "scene/geometries.h"
#include "support/lock.h"

namespace pierce::scene {

struct Surface {
  std::optional<Error> odd;         ///< why parity means nothing, unless it does
  std::optional<Error> unbalanced;  ///< why winding numbers mean nothing, unless they do
};

/// Takes all geometries together, vertices by position. Throws Error (TooManyTriangles) if their
/// vertices, of several meshes together, are 2^32 - 1 or more, (Stopped).
template <class Real>
Surface examine_surface(const Geometries<Real>& geometries, const WorkOptions& work);

/// A scene's triangles without those that lie where an earlier one does, for InsideRule::Unique.
/// Without lists: there is no such triangle.
template <class Real>
struct Unrepeated {
  std::vector<std::vector<Triangle>> triangles;   ///< of each geometry
  std::vector<std::vector<Vec3<Real>>> vertices;  ///< where these are not the caller's
  std::vector<MeshView<Real>> views;              ///< of these; may be moved with them
  std::optional<Error> fault;                     ///< why parity means nothing, unless it does
};

/// Throws as examine_surface does.
template <class Real>
Unrepeated<Real> leave_out_repeats(const Geometries<Real>& geometries, const WorkOptions& work);

/// Throws Error (NotClosed) if the rule means nothing for the surface.
void validate_closed(const Surface& surface, InsideRule rule);

/// What is examined when it is first asked for. Thread-safe: one thread examines, others wait for
/// it or until they are stopped; if the one is stopped, the next takes over.
class LazySurface {
 public:
  LazySurface() = default;
  /// What is known already.
  explicit LazySurface(Surface known) : surface_(std::move(known)) {
    examined_.call([] {}, [] {});
  }

  template <class Real>
  const Surface& of(const Geometries<Real>& geometries, const WorkOptions& work);

  /// Whether some triangle stands in several leaves of the tree.
  bool repeats(const bvh::Tree& tree, std::uint32_t triangles);

 private:
  parallel::Once examined_;
  Surface surface_;
  parallel::Once counted_;
  bool repeats_ = false;
};

}  // namespace pierce::scene
