// SPDX-License-Identifier: Apache-2.0
#include "scene/geometries.h"

#include <string>
#include <utility>

#include "scene/validate_input.h"
#include "space/filter_ray.h"
#include "support/build_control.h"
#include "support/parallel.h"

namespace pierce::scene {
namespace {

/// What one pass over the triangles of a mesh finds out.
struct Survey {
  Extent extent;
  bool valid = true;
};

template <class Real>
Survey survey(const MeshView<Real>& mesh, const bvh::BuildControl& control) {
  return parallel::reduce(
      std::size_t{0}, mesh.triangles.size(), 16384, Survey{},
      [&](std::size_t first, std::size_t last) {
        control.poll();
        Survey found;
        for (const Triangle& t : mesh.triangles.subspan(first, last - first)) {
          if (!is_valid(mesh, t)) [[unlikely]] {
            found.valid = false;
            return found;
          }
          for (const std::uint32_t vertex : t) {
            found.extent.include(predicate::to_double(mesh.vertices[vertex]));
          }
        }
        return found;
      },
      [](Survey a, const Survey& b) {
        a.extent.include(b.extent);
        a.valid &= b.valid;
        return a;
      });
}

}  // namespace

template <class Real>
void Geometries<Real>::count_triangles() {
  std::uint64_t count = 0;  // known before anything is looked at
  for (const MeshView<Real>& mesh : meshes_) count += mesh.triangles.size();
  if (count >= kNone) {
    throw Error(ErrorCode::TooManyTriangles,
                "too many triangles: at most " + std::to_string(kNone - 1) +
                    " fit in one scene; split the meshes over several");
  }
  for (const MeshView<Real>& mesh : meshes_) {
    first_.push_back(first_.back() + static_cast<std::uint32_t>(mesh.triangles.size()));
  }
  if (meshes_.size() < 2) return;
  while ((first_.back() >> run_bits_) > 4 * meshes_.size()) ++run_bits_;
  const std::uint32_t runs = (first_.back() >> run_bits_) + 1;
  std::uint32_t entry = 0;  // the first that is above the run's first primitive
  for (std::uint32_t run = 0; run < runs; ++run) {
    while (entry < first_.size() && first_[entry] <= run << run_bits_) ++entry;
    run_first_.push_back(entry);
  }
  run_first_.push_back(static_cast<std::uint32_t>(first_.size()));
}

template <class Real>
Geometries<Real>::Geometries(std::span<const MeshView<Real>> meshes, const BuildOptions& options)
    : meshes_(meshes.begin(), meshes.end()) {
  set_masks(options.masks);
  count_triangles();
  const bvh::BuildControl control(options.work);
  Extent extent;
  for (std::size_t geometry = 0; geometry < meshes.size(); ++geometry) {
    const MeshView<Real>& mesh = meshes[geometry];
    const Survey found =
        parallel::with_threads(options.work.threads, [&] { return survey(mesh, control); });
    if (!found.valid) validate_mesh(mesh, geometry, meshes.size());  // says what is wrong
    extent.include(found.extent);
  }
  set_extent(extent);
}

template <class Real>
Geometries<Real>::Geometries(std::span<const MeshView<Real>> meshes,
                             std::span<const std::uint32_t> masks, const Extent& extent,
                             std::string file)
    : meshes_(meshes.begin(), meshes.end()), from_file_(true), file_(std::move(file)) {
  set_masks(masks);
  count_triangles();
  set_extent(extent);
}

template <class Real>
void Geometries<Real>::set_masks(std::span<const std::uint32_t> masks) {
  masks_.assign(masks.begin(), masks.end());
  if (masks_.empty()) return;
  if (masks_.size() != meshes_.size()) {
    throw Error(ErrorCode::SizeMismatch,
                "there are " + std::to_string(meshes_.size()) + " geometries but " +
                    std::to_string(masks_.size()) + " masks: " +
                    (masks_.size() < meshes_.size()
                         ? "geometry " + std::to_string(masks_.size()) + " has none"
                         : "there is no geometry " + std::to_string(meshes_.size())) +
                    "; give none, or one a geometry");
  }
  kinds_ = masks_;
  std::sort(kinds_.begin(), kinds_.end());
  kinds_.erase(std::unique(kinds_.begin(), kinds_.end()), kinds_.end());
  hidden_ = kinds_.front() == 0;
}

template <class Real>
void Geometries<Real>::set_extent(const Extent& extent) {
  extent_ = extent;
  space_ = space::FilterSpace(extent.lower, extent.upper);
  // Doubles are often floats that were widened on their way.
  copies_usable_ = copies_exact_ = extent.floats && space_.maps_floats_exactly(extent.smallest);
  affine_map_ = space_.affine_map(copies_exact_);
}

template <class Real>
Geometries<Real>::Geometries(std::span<const Instance<Real>> placed,
                             std::vector<const Geometries*> local, const Extent& extent,
                             const BuildOptions& options)
    : local_(std::move(local)), extent_(extent), space_(extent.lower, extent.upper) {
  for (const Instance<Real>& instance : placed) {
    meshes_.push_back(instance.mesh);
    transforms_.push_back(instance.transform);
  }
  set_masks(options.masks);
  count_triangles();
  affine_map_ = space_.affine_map(false);
}

template <class Real>
void Geometries<Real>::refuse(const char* why) const {
  throw Error(ErrorCode::BadFile, file_ + ": is damaged: " + why + "; build the scene anew");
}

template <class Real>
void Geometries<Real>::check(const predicate::TriangleD& t) const {
  if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c))
    refuse("a corner of a triangle is not finite");
}

template <class Real>
predicate::TriangleD Geometries<Real>::examined(std::uint32_t primitive) const {
  check(primitive);
  const std::uint32_t geometry = geometry_of(primitive);
  const MeshView<Real>& mesh = meshes_[geometry];
  const Triangle& t = mesh.triangles[primitive - first_[geometry]];
  for (const std::uint32_t corner : t) {
    if (corner >= mesh.vertices.size()) refuse("a triangle names a vertex that is not there");
  }
  const predicate::TriangleD corners = {predicate::to_double(mesh.vertices[t[0]]),
                                        predicate::to_double(mesh.vertices[t[1]]),
                                        predicate::to_double(mesh.vertices[t[2]])};
  check(corners);
  return corners;
}

template <class Real>
void Geometries<Real>::examine() const {
  if (!from_file_) return;
  const WorkOptions work;
  const bvh::BuildControl control(work);
  for (const MeshView<Real>& mesh : meshes_) {
    if (!survey(mesh, control).valid)
      refuse("a triangle names a vertex that is not there or not finite");
  }
}

template class Geometries<float>;
template class Geometries<double>;

}  // namespace pierce::scene
