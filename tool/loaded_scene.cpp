// SPDX-License-Identifier: Apache-2.0
#include "loaded_scene.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <span>
#include <type_traits>
#include <utility>

#include "interrupt.h"
#include "progress_bar.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

// Why there is no scene, although a file of one was given: it has other numbers.
template <class Real>
void tell_of_other_numbers(std::span<const Geometry> geometries) {
  using Other = std::conditional_t<std::is_same_v<Real, float>, double, float>;
  if (geometries.empty() || geometries[0].stored == nullptr ||
      geometries[0].stored->template scene<Other>() == nullptr)
    return;
  constexpr const char* kOwn = std::is_same_v<Real, float> ? "float" : "double";
  constexpr const char* kOther = std::is_same_v<Real, float> ? "double" : "float";
  remark(
      fmt::format("pierce: {} holds a {} scene; what is asked needs one in {}, which is built of "
                  "its mesh (--precision {} asks its own)\n",
                  geometries[0].file, kOther, kOwn, kOther));
}

template <class Real>
std::vector<Vec3<Real>> take_vertices(Geometry& geometry) {
  if (geometry.stored != nullptr) {
    if (geometry.stored->scene<Real>() != nullptr) return {};  // they stay where they are
    return naming_file(geometry.name(),
                       [&] { return geometry.stored->converted<Real>(geometry.number); });
  }
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
    const Geometry& geometry = geometries_[i];
    if (geometry.stored == nullptr) {
      views_.push_back({vertices_[i], geometry.mesh.triangles});
    } else if (const Scene<Real>* scene = geometry.stored->template scene<Real>()) {
      views_.push_back(scene->meshes()[geometry.number]);
    } else {
      views_.push_back({vertices_[i], geometry.stored->triangles(geometry.number)});
    }
  }
}

template <class Real>
std::span<const MeshView<Real>> Meshes<Real>::views() const {
  const StoredScene* last = nullptr;
  for (const Geometry& geometry : geometries_) {
    if (looked_at_ || geometry.stored == nullptr || geometry.stored.get() == last) continue;
    last = geometry.stored.get();
    last->check_meshes();
  }
  looked_at_ = true;
  return views_;
}

template <class Real>
const Scene<Real>* Meshes<Real>::stored_scene() const {
  const auto stored = geometries_.empty() ? nullptr : geometries_[0].stored;
  if (stored == nullptr || stored->info().geometries.size() != geometries_.size()) return nullptr;
  for (std::size_t i = 0; i < geometries_.size(); ++i) {
    if (geometries_[i].stored != stored || geometries_[i].number != i) return nullptr;
  }
  return stored->template scene<Real>();
}

template <class Real>
std::uint64_t Meshes<Real>::triangles() const {
  std::uint64_t count = 0;
  for (const MeshView<Real>& view : views_) count += view.triangles.size();
  return count;
}

template <class Real>
LoadedScene<Real>::LoadedScene(std::vector<Geometry> geometries, const BuildOptions& options)
    : meshes_(std::move(geometries)) {
  if (meshes_.stored_scene() != nullptr) {
    build_seconds_ = meshes_.geometries()[0].stored->load_seconds();
    return;
  }
  tell_of_other_numbers<Real>(meshes_.geometries());
  const Stopwatch watch;
  scene_ = build<Real>(meshes_, options);
  build_seconds_ = watch.seconds();
}

template <class Real>
void LoadedScene<Real>::add_size_to(Summary& table) const {
  if (meshes_.size() > 1) table.add("geometries", grouped(meshes_.size()));
  table.add("triangles", grouped(meshes_.triangles()));
}

template <class Real>
void LoadedScene<Real>::add_to(Summary& table) const {
  table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
  table.add(meshes_.stored_scene() != nullptr ? "load" : "build", seconds(build_seconds_));
}

template class Meshes<float>;
template class Meshes<double>;
template class LoadedScene<float>;
template class LoadedScene<double>;

}  // namespace pierce::tool
