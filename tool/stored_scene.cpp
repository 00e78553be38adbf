// SPDX-License-Identifier: Apache-2.0
#include "stored_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <type_traits>

#include "interrupt.h"
#include "io/mesh.h"
#include "pierce/vector.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

template <class Real>
bool is_whole(const Scene<Real>& scene) {
  for (const MeshView<Real>& mesh : scene.meshes()) {
    const std::size_t count = mesh.vertices.size();
    for (const Triangle& t : mesh.triangles) {
      if (std::max({t[0], t[1], t[2]}) >= count) return false;
    }
  }
  return true;
}

}  // namespace

bool is_scene_file(const std::string& path) {
  // A pipe is not touched: what is read from it is gone.
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  char first[4] = {};
  return std::ifstream(path, std::ios::binary).read(first, sizeof first) &&
         std::string_view(first, sizeof first) == "\x89PRC";
}

StoredScene::StoredScene(const std::string& path, bool verify)
    : path_(path), info_(scene_file_info(path)) {
  const interrupt::Graceful graceful;
  const LoadOptions options{.verify = verify, .work = {.stop = interrupt::stop()}};
  const Stopwatch watch;
  if (info_.bits == 32) {
    float_ = Scene<float>::load(path, options);
  } else {
    double_ = Scene<double>::load(path, options);
  }
  load_seconds_ = watch.seconds();
}

template <class Real>
const Scene<Real>* StoredScene::scene() const {
  if constexpr (std::is_same_v<Real, float>) {
    return float_ ? &*float_ : nullptr;
  } else {
    return double_ ? &*double_ : nullptr;
  }
}

template <class Real>
std::vector<Vec3<Real>> StoredScene::converted(std::size_t geometry) const {
  if constexpr (std::is_same_v<Real, float>) {
    return io::to_float(double_->meshes()[geometry].vertices);
  } else {
    std::vector<Vec3<double>> wide;
    for (const Vec3<float>& p : float_->meshes()[geometry].vertices)
      wide.push_back(convert<double>(p));
    return wide;
  }
}

std::span<const Triangle> StoredScene::triangles(std::size_t geometry) const {
  return float_ ? float_->meshes()[geometry].triangles : double_->meshes()[geometry].triangles;
}

void StoredScene::check_meshes() const {
  if (float_ ? is_whole(*float_) : is_whole(*double_)) return;
  throw Error(ErrorCode::BadFile, path_ +
                                      ": is damaged: a triangle names a vertex that is not there; "
                                      "copy it again, or build the scene anew");
}

template const Scene<float>* StoredScene::scene() const;
template const Scene<double>* StoredScene::scene() const;
template std::vector<Vec3<float>> StoredScene::converted(std::size_t) const;
template std::vector<Vec3<double>> StoredScene::converted(std::size_t) const;

}  // namespace pierce::tool
