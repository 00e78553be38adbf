// SPDX-License-Identifier: Apache-2.0
//
// A scene file on the command line, in the place of a mesh.
#pragma once

#include <optional>
#include <string>

#include "pierce/scene.h"

namespace pierce::tool {

/// Whether the file begins as scene files do.
[[nodiscard]] bool is_scene_file(const std::string& path);

class StoredScene {
 public:
  StoredScene(const std::string& path, bool verify);

  [[nodiscard]] const SceneFileInfo& info() const { return info_; }
  [[nodiscard]] double load_seconds() const { return load_seconds_; }
  /// The scene, if its numbers are Reals; else nullptr.
  template <class Real>
  [[nodiscard]] const Scene<Real>* scene() const;

  /// A geometry's vertices in the type that the scene does not have.
  template <class Real>
  [[nodiscard]] std::vector<Vec3<Real>> converted(std::size_t geometry) const;
  [[nodiscard]] std::span<const Triangle> triangles(std::size_t geometry) const;

  /// Throws Error (BadFile) if an index of a mesh leads out of it: for what looks at the meshes
  /// itself, as only queries look at what they meet.
  void check_meshes() const;

 private:
  std::string path_;
  SceneFileInfo info_;
  double load_seconds_ = 0;
  std::optional<Scene<float>> float_;
  std::optional<Scene<double>> double_;
};

}  // namespace pierce::tool
