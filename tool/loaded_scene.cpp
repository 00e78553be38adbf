// SPDX-License-Identifier: Apache-2.0
#include "loaded_scene.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <type_traits>
#include <utility>

#include "failure.h"
#include "interrupt.h"
#include "io/read_mesh.h"
#include "output.h"
#include "progress_bar.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

template <class Real>
std::vector<Vec3<Real>> take_vertices(const std::string& path, io::Mesh& mesh) {
  std::vector<Vec3<double>> vertices = std::exchange(mesh.vertices, {});
  if constexpr (std::is_same_v<Real, double>) {
    return vertices;
  } else {
    return naming_file(path, [&] { return io::to_float(vertices); });
  }
}

template <class Real>
Scene<Real> build(const std::string& path, MeshView<Real> mesh, BuildOptions options) {
  ProgressBar bar("build");
  options.work.progress = bar.callback();
  options.work.stop = interrupt::stop();
  const interrupt::Graceful graceful;
  return naming_file(path, [&] { return Scene<Real>::build(mesh, options); });
}

}  // namespace

void add_precision_option(CLI::App& app, Precision& precision) {
  static const std::map<std::string, Precision> names = {
      {"auto", Precision::Auto}, {"float", Precision::Float}, {"double", Precision::Double}};
  app.add_option("--precision", precision,
                 "Numbers to compute with and to write: float, double, or auto: float if all input "
                 "is 32-bit by what its files declare (PLY with float properties, also as text; "
                 "binary STL, glTF, 3DS, float32 arrays), else double")
      ->transform(CLI::Transformer(names).description("auto|float|double"))
      ->default_str("auto");
}

void add_threads_option(CLI::App& app, unsigned& threads) {
  app.add_option("--threads", threads, "Threads to use; 0: as many as the machine has")
      ->check(CLI::Range(0U, 4096U).description("N"))
      ->default_str("0");
}

io::Mesh read_triangles(const std::string& path) {
  io::Mesh mesh = io::read_mesh(path);
  if (!mesh.triangles.empty()) return mesh;
  throw Error(ErrorCode::BadFile,
              fmt::format("{}: holds no triangle ({} vertices); give a mesh that has faces", path,
                          grouped(mesh.vertices.size())));
}

bool choose_float(Precision precision, const std::string& mesh_path, bool mesh_single,
                  const std::string& other, bool other_single) {
  if (precision != Precision::Float) {
    return precision == Precision::Auto && mesh_single && other_single;
  }
  const std::string rounded = mesh_single    ? (other_single ? "" : other)
                              : other_single ? mesh_path
                                             : mesh_path + " and " + other;
  if (!rounded.empty()) {
    remark(fmt::format("pierce: --precision float: the numbers of {} are rounded to 32 bits\n",
                       rounded));
  }
  return true;
}

template <class Real>
LoadedScene<Real>::LoadedScene(const std::string& path, io::Mesh mesh, const BuildOptions& options)
    : path_(path), mesh_(std::move(mesh)), vertices_(take_vertices<Real>(path, mesh_)), scene_([&] {
        const Stopwatch watch;
        Scene<Real> scene = build<Real>(path, {vertices_, mesh_.triangles}, options);
        build_seconds_ = watch.seconds();
        return scene;
      }()) {}

template <class Real>
void LoadedScene<Real>::add_to(Summary& table) const {
  table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
  table.add("build", seconds(build_seconds_));
}

template class LoadedScene<float>;
template class LoadedScene<double>;

}  // namespace pierce::tool
