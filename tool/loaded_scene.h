// SPDX-License-Identifier: Apache-2.0
//
// A mesh file made into a scene: what almost every command begins with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/mesh.h"
#include "output.h"
#include "pierce/scene.h"

namespace CLI {
class App;
}

namespace pierce::tool {

/// What --precision says. Auto takes float where that loses nothing.
enum class Precision : std::uint8_t { Auto, Float, Double };

void add_precision_option(CLI::App& app, Precision& precision);
void add_threads_option(CLI::App& app, unsigned& threads);

/// Reads the file; a mesh without a single triangle is Error (BadFile).
[[nodiscard]] io::Mesh read_triangles(const std::string& path);

/// Whether to compute in float. Says so in a remark if that rounds numbers. `other` names the
/// second input file, if there is one, and `other_single` whether its numbers are 32 bits long.
[[nodiscard]] bool choose_float(Precision precision, const std::string& mesh_path, bool mesh_single,
                                const std::string& other = {}, bool other_single = true);

/// Owns the vertices and triangles that its scene refers to. May be moved.
template <class Real>
class LoadedScene {
 public:
  /// Builds the scene, with a progress bar, and gives up the mesh's coordinates in other types.
  LoadedScene(const std::string& path, io::Mesh mesh, const BuildOptions& options);

  [[nodiscard]] const Scene<Real>& scene() const { return scene_; }
  [[nodiscard]] MeshView<Real> view() const { return {vertices_, mesh_.triangles}; }
  [[nodiscard]] const io::Mesh& mesh() const { return mesh_; }  ///< attributes; no vertices
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] double build_seconds() const { return build_seconds_; }
  /// What a summary says about it: the type of its numbers, and how long it took to build.
  void add_to(Summary& table) const;

 private:
  std::string path_;
  io::Mesh mesh_;
  std::vector<Vec3<Real>> vertices_;
  double build_seconds_ = 0;
  Scene<Real> scene_;
};

extern template class LoadedScene<float>;
extern template class LoadedScene<double>;

}  // namespace pierce::tool
