// SPDX-License-Identifier: Apache-2.0
#include "scene/placed_meshes.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <utility>

#include "scene/mesh_arrays.h"
#include "scene/rounded_image.h"
#include "scene/validate_input.h"
#include "support/build_control.h"
#include "support/finite.h"
#include "support/float_environment.h"
#include "support/parallel.h"

namespace pierce {
namespace {

template <class Real>
bool is_finite(const Transform<Real>& transform) {
  for (const auto& row : transform.rows) {
    for (const Real x : row) {
      if (!is_finite_number(x)) return false;
    }
  }
  return true;
}

}  // namespace

template <class Real>
Vec3<Real> transformed(const Transform<Real>& transform, const Vec3<Real>& point) {
  const FloatEnvironment environment;
  if (!is_finite(transform) || !scene::is_finite(point)) {
    throw Error(ErrorCode::InvalidArgument,
                "a number of the transform or of the point is not finite; give finite ones");
  }
  const Vec3<Real> image = environment.made(scene::rounded_image(transform, point));
  if (!scene::is_finite(image)) {
    throw Error(ErrorCode::NonFiniteVertex,
                "the transformed point is too large for its type; transform by less");
  }
  return image;
}

template Vec3<float> transformed(const Transform<float>&, const Vec3<float>&);
template Vec3<double> transformed(const Transform<double>&, const Vec3<double>&);

namespace scene {
namespace {

/// Throws Error that names the first vertex which a triangle uses and which the transform makes too
/// large.
template <class Real>
void validate_images(const MeshView<Real>& mesh, std::span<const Vec3<Real>> images,
                     std::size_t instance) {
  std::vector<std::uint32_t> bad;
  for (const Triangle& triangle : mesh.triangles) {
    if (!is_valid(mesh, triangle)) continue;
    for (const std::uint32_t vertex : triangle) {
      if (!is_finite(images[vertex])) bad.push_back(vertex);
    }
  }
  if (bad.empty()) return;
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  throw Error(ErrorCode::NonFiniteVertex,
              "vertex " + std::to_string(bad[0]) + " of instance " + std::to_string(instance) +
                  counted(bad.size()) +
                  " is too large for the scene's type once transformed; transform by less",
              bad[0], bad.size());
}

template <class Real>
std::vector<Vec3<Real>> images_of(const Instance<Real>& instance, std::size_t number,
                                  const bvh::BuildControl& control) {
  const std::span<const Vec3<Real>> vertices = instance.mesh.vertices;
  std::vector<Vec3<Real>> images(vertices.size());
  std::atomic<bool> too_large = false;
  const auto place = [&](std::size_t first, std::size_t last) {
    control.poll();
    for (std::size_t i = first; i != last; ++i) {
      if (!is_finite(vertices[i])) [[unlikely]] {
        images[i] = vertices[i];
        continue;
      }
      images[i] = rounded_image(instance.transform, vertices[i]);
      if (!is_finite(images[i])) [[unlikely]]
        too_large = true;
    }
  };
  parallel::for_ranges(std::size_t{0}, vertices.size(), 4096, place);
  if (too_large) validate_images<Real>(instance.mesh, images, number);
  return images;
}

}  // namespace

template <class Real>
std::vector<Vec3<Real>> transformed_vertices(const Instance<Real>& instance, std::size_t number,
                                             const WorkOptions& work) {
  const bvh::BuildControl control(work);
  return parallel::with_threads(work.threads, [&] { return images_of(instance, number, control); });
}

template <class Real>
void validate_transforms(std::span<const Instance<Real>> instances) {
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (pierce::is_finite(instances[i].transform)) continue;
    throw Error(
        ErrorCode::InvalidArgument,
        "the transform of instance " + std::to_string(i) + " is not finite; give finite numbers",
        i);
  }
}

template <class Real>
PlacedMeshes<Real>::PlacedMeshes(std::span<const Instance<Real>> instances,
                                 const BuildOptions& options)
    : instances_(instances.begin(), instances.end()), owned_(instances.size()) {
  validate_transforms(instances);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Instance<Real>& instance = instances[i];
    MeshView<Real> view = instance.mesh;
    if (instance.transform != Transform<Real>{}) {
      owned_[i].vertices = transformed_vertices(instance, i, options.work);
      view.vertices = owned_[i].vertices;
    }
    views_.push_back(view);
  }
}

template <class Real>
PlacedMeshes<Real>::PlacedMeshes(std::vector<Mesh<Real>> meshes) : owned_(std::move(meshes)) {
  for (const Mesh<Real>& mesh : owned_) views_.push_back(mesh.view());
}

template <class Real>
PlacedMeshes<Real>::PlacedMeshes(std::span<const MeshArrays<Real>> meshes, const WorkOptions& work)
    : arrays_(meshes.begin(), meshes.end()), owned_(meshes.size()) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::string where = meshes.size() > 1 ? " of geometry " + std::to_string(i) : "";
    views_.push_back(view_or_copy(meshes[i], where, StopPoll(work.stop), owned_[i]));
  }
}

template <class Real>
std::uint64_t PlacedMeshes<Real>::bytes() const {
  std::uint64_t bytes = 0;
  for (const Mesh<Real>& mesh : owned_) {
    bytes += mesh.vertices.size() * sizeof(Vec3<Real>) + mesh.triangles.size() * sizeof(Triangle);
  }
  return bytes;
}

template std::vector<Vec3<float>> transformed_vertices(const Instance<float>&, std::size_t,
                                                       const WorkOptions&);
template std::vector<Vec3<double>> transformed_vertices(const Instance<double>&, std::size_t,
                                                        const WorkOptions&);
template void validate_transforms(std::span<const Instance<float>>);
template void validate_transforms(std::span<const Instance<double>>);
template class PlacedMeshes<float>;
template class PlacedMeshes<double>;

}  // namespace scene
}  // namespace pierce
