// SPDX-License-Identifier: Apache-2.0
#include "loaded_scene.h"

#include <CLI/CLI.hpp>
#include <type_traits>
#include <utility>

#include "interrupt.h"
#include "progress_bar.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

template <class Real>
std::vector<Vec3<Real>> take_vertices(Geometry& geometry) {
  std::vector<Vec3<double>> vertices = std::exchange(geometry.mesh.vertices, {});
  if constexpr (std::is_same_v<Real, double>) {
    return vertices;
  } else {
    return naming_file(geometry.name(), [&] { return io::to_float(vertices); });
  }
}

template <class Real>
Scene<Real> build(const Meshes<Real>& meshes, BuildOptions options) {
  const auto geometries = meshes.geometries();
  const auto views = meshes.views();
  ProgressBar bar("build");
  options.work.progress = bar.callback();
  options.work.stop = interrupt::stop();
  const interrupt::Graceful graceful;
  try {
    return Scene<Real>::build(views, options);
  } catch (const Error& e) {
    // Which of several it is, the library can only number: it is asked about one at a time.
    const bool of_one =
        e.code() == ErrorCode::NonFiniteVertex || e.code() == ErrorCode::IndexOutOfRange;
    for (std::size_t i = 0; of_one && i < views.size(); ++i) {
      naming_file(geometries[i].name(), [&] { (void)Scene<Real>::build(views[i], options); });
    }
    if (views.size() != 1) throw;  // about all of them
    return naming_file(geometries[0].name(), []() -> Scene<Real> { throw; });
  }
}

}  // namespace

void add_threads_option(CLI::App& app, unsigned& threads) {
  app.add_option("--threads", threads, "Threads to use; 0: as many as the machine has")
      ->check(CLI::Range(0U, 4096U).description("N"))
      ->default_str("0");
}

template <class Real>
Meshes<Real>::Meshes(std::vector<Geometry> geometries) : geometries_(std::move(geometries)) {
  for (Geometry& geometry : geometries_) vertices_.push_back(take_vertices<Real>(geometry));
  for (std::size_t i = 0; i < geometries_.size(); ++i) {
    views_.push_back({vertices_[i], geometries_[i].mesh.triangles});
  }
}

template <class Real>
std::uint64_t Meshes<Real>::triangles() const {
  std::uint64_t count = 0;
  for (const MeshView<Real>& view : views_) count += view.triangles.size();
  return count;
}

template <class Real>
LoadedScene<Real>::LoadedScene(std::vector<Geometry> geometries, const BuildOptions& options)
    : meshes_(std::move(geometries)), scene_([&] {
        const Stopwatch watch;
        Scene<Real> scene = build<Real>(meshes_, options);
        build_seconds_ = watch.seconds();
        return scene;
      }()) {}

template <class Real>
void LoadedScene<Real>::add_size_to(Summary& table) const {
  if (views().size() > 1) table.add("geometries", grouped(views().size()));
  table.add("triangles", grouped(meshes_.triangles()));
}

template <class Real>
void LoadedScene<Real>::add_to(Summary& table) const {
  table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
  table.add("build", seconds(build_seconds_));
}

template class Meshes<float>;
template class Meshes<double>;
template class LoadedScene<float>;
template class LoadedScene<double>;

}  // namespace pierce::tool
