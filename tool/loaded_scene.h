// SPDX-License-Identifier: Apache-2.0
//
// Mesh files made into a scene: what almost every command begins with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometries.h"
#include "output.h"
#include "pierce/scene.h"

namespace CLI {
class App;
}

namespace pierce::tool {

void add_threads_option(CLI::App& app, unsigned& threads);

/// Geometries with their coordinates in one type; owns what the views refer to. May be moved.
template <class Real>
class Meshes {
 public:
  /// Gives up the coordinates in other types. Throws Error (InvalidArgument) with the name of the
  /// geometry if a vertex does not fit.
  explicit Meshes(std::vector<Geometry> geometries);

  /// Those of a scene file are looked at first: Error (BadFile) if an index leads out of one.
  [[nodiscard]] std::span<const MeshView<Real>> views() const;
  [[nodiscard]] std::size_t size() const { return views_.size(); }
  /// The scene over just these that a scene file holds, if it does; else nullptr.
  [[nodiscard]] const Scene<Real>* stored_scene() const;
  /// Names and attributes; no vertices.
  [[nodiscard]] std::span<const Geometry> geometries() const { return geometries_; }
  [[nodiscard]] std::uint64_t triangles() const;  ///< of all geometries

 private:
  std::vector<Geometry> geometries_;
  std::vector<std::vector<Vec3<Real>>> vertices_;
  std::vector<MeshView<Real>> views_;
  mutable bool looked_at_ = false;
};

/// Meshes and the scene over them. May be moved.
template <class Real>
class LoadedScene {
 public:
  /// Builds the scene, with a progress bar, or takes that of a scene file.
  LoadedScene(std::vector<Geometry> geometries, const BuildOptions& options);

  [[nodiscard]] const Scene<Real>& scene() const {
    return scene_ ? *scene_ : *meshes_.stored_scene();
  }
  [[nodiscard]] const Meshes<Real>& meshes() const { return meshes_; }
  [[nodiscard]] std::span<const MeshView<Real>> views() const { return meshes_.views(); }
  [[nodiscard]] double build_seconds() const { return build_seconds_; }

  /// What a summary says of its size: triangles, and geometries if there are several.
  void add_size_to(Summary& table) const;
  /// The type of its numbers, and how long it took to build.
  void add_to(Summary& table) const;

 private:
  Meshes<Real> meshes_;
  double build_seconds_ = 0;
  std::optional<Scene<Real>> scene_;  // none if a scene file has it
};

extern template class Meshes<float>;
extern template class Meshes<double>;
extern template class LoadedScene<float>;
extern template class LoadedScene<double>;

}  // namespace pierce::tool
