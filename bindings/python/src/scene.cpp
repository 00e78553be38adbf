// SPDX-License-Identifier: Apache-2.0
//
// A scene is made, changed, and says what it is.
#include "scene.h"

#include <nanobind/stl/string.h>

#include <atomic>
#include <string>
#include <utility>

namespace pierce::python {

std::vector<const void*>& asked_in_this_thread() {
  thread_local std::vector<const void*> asked;
  return asked;
}

std::vector<const void*>& changed_in_this_thread() {
  thread_local std::vector<const void*> changed;
  return changed;
}

std::uint64_t next_version() {
  static std::atomic<std::uint64_t> last = kAnyVersion;
  return ++last;
}

template <class Real>
SceneOf<Real>::SceneOf(const nb::list& meshes, int quality, nb::handle masks,
                       std::uint64_t flatten_limit, const Control& control)
    : meshes_(meshes) {
  const Buffer mask_buffer(masks, "masks");
  BuildOptions options{.quality = static_cast<Quality>(quality),
                       .masks = mask_buffer.packed<const std::uint32_t, const std::uint32_t>(),
                       .flatten_limit = flatten_limit};
  triangles_ = meshes_->triangles;
  run(control, triangles_ <= 2048 ? Length::Brief : Length::Long, [&](const WorkOptions& work) {
    options.work = work;
    if (meshes_->instances.empty()) {
      scene_ = Scene<Real>::build(std::span<const MeshView<Real>>(meshes_->views), options);
    } else {
      scene_ = Scene<Real>::build(std::span<const Instance<Real>>(meshes_->instances), options);
    }
  });
}

template <class Real>
SceneOf<Real>::SceneOf(const nb::bytes& path, bool verify, const Control& control) {
  const std::string file(path.c_str(), path.size());
  run(control, verify ? Length::Long : Length::Brief, [&](const WorkOptions& work) {
    scene_ = Scene<Real>::load(file, {.verify = verify, .work = work});
  });
  for (const MeshView<Real>& mesh : scene_->meshes()) triangles_ += mesh.triangles.size();
}

template <class Real>
void SceneOf<Real>::save(const nb::bytes& path, const nb::list& list, const Control& control) {
  const std::string file(path.c_str(), path.size());
  std::vector<std::string> names;
  for (nb::handle name : list) names.push_back(nb::cast<std::string>(name));
  const Asking scene(*this);
  run(control, Length::Long,
      [&](const WorkOptions& work) { scene->save(file, {.names = names, .work = work}); });
}

template <class Real>
void SceneOf<Real>::refit(const nb::list& list, nb::object known, const Control& control) {
  std::optional<Meshes> meshes(std::in_place, list);
  const Changing changing(*this);
  const Length length = triangles_ <= 2048 ? Length::Brief : Length::Long;
  const std::atomic<bool> never = false;
  bool changed = false;
  const auto fit = [&](WorkOptions work) {
    // What might be stopped is done to a copy, so that lack of memory changes nothing either.
    if (work.stop == nullptr) work.stop = &never;
    if (meshes->instances.empty()) {
      scene_->refit(std::span<const MeshView<Real>>(meshes->views), work);
    } else {
      scene_->refit(std::span<const Instance<Real>>(meshes->instances), work);
    }
    changed = true;
  };
  // The scene looks at the new arrays from then on, whatever happens next: the old ones go.
  const auto keep = [&] {
    if (!changed) return;
    meshes_.swap(meshes);
    std::swap(known_, known);
    version_ = next_version();
  };
  try {
    run(control, length, fit, Work::Changes);
  } catch (...) {
    keep();
    throw;
  }
  keep();
}

template <class Real>
nb::dict SceneOf<Real>::info() {
  const Asking scene(*this);
  SceneInfo info;
  run({}, Length::Long, [&](const WorkOptions&) { info = scene->info(); });
  nb::dict result;
  result["triangles"] = info.triangles;
  result["vertices"] = info.vertices;
  result["degenerate"] = info.degenerate;
  result["nodes"] = info.nodes;
  result["leaves"] = info.leaves;
  result["sah_cost"] = info.sah_cost;
  result["bytes"] = info.bytes;
  return result;
}

template class SceneOf<float>;
template class SceneOf<double>;

}  // namespace pierce::python
