// SPDX-License-Identifier: Apache-2.0
#include "scene/two_level.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "bvh/box.h"
#include "bvh/leaf_access.h"
#include "scene/fine_parts.h"
#include "scene/placed_meshes.h"
#include "scene/validate_input.h"
#include "support/build_control.h"
#include "support/parallel.h"
#include "support/stop_poll.h"

namespace pierce::scene {
namespace {

using space::MiddleBox;

/// What makes two instances' meshes the same one: they lie in the same place.
template <class Real>
auto identity_of(const MeshView<Real>& mesh) {
  return std::tuple(static_cast<const void*>(mesh.vertices.data()), mesh.vertices.size(),
                    static_cast<const void*>(mesh.triangles.data()), mesh.triangles.size());
}

/// The number of a mesh by its first instance.
template <class Real>
class Meshes {
 public:
  /// Counts up from 0 as meshes are met for the first time.
  std::uint32_t number(const MeshView<Real>& mesh) {
    return known_.emplace(identity_of(mesh), static_cast<std::uint32_t>(known_.size()))
        .first->second;
  }
  [[nodiscard]] std::size_t size() const { return known_.size(); }

 private:
  std::map<decltype(identity_of(MeshView<Real>{})), std::uint32_t> known_;
};

template <class Real>
space::Affine in_double(const Transform<Real>& transform) {
  space::Affine affine;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) affine[i][j] = static_cast<double>(transform.rows[i][j]);
  }
  return affine;
}

Vec3<double> largest(const Vec3<double>& lower, const Vec3<double>& upper) {
  const auto of = [](double p, double q) { return std::max(std::fabs(p), std::fabs(q)); };
  return {of(lower.x, upper.x), of(lower.y, upper.y), of(lower.z, upper.z)};
}

/// What rounding to the type loses at most: of a number, or anyway.
template <class Real>
struct Rounding {
  static constexpr double kUlp = 0.5 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  static constexpr double kTiny = static_cast<double>(std::numeric_limits<Real>::denorm_min());
};

template <class Real>
space::PlacedExtent extent_of(const Bottom<Real>& bottom, const Transform<Real>& transform) {
  const Extent& of = bottom.geometries.extent();
  const bool moved = transform != Transform<Real>{};
  return {in_double(transform), largest(of.lower, of.upper), moved ? Rounding<Real>::kUlp : 0,
          moved ? Rounding<Real>::kTiny : 0};
}

/// The box of a mesh's placed vertices in the scene's coordinates; nothing if they may be too large
/// for the type, or nearly.
template <class Real>
std::optional<Extent> placed_box(const Bottom<Real>& bottom, const Transform<Real>& transform) {
  const Extent& of = bottom.geometries.extent();
  if (!(of.lower.x <= of.upper.x)) return std::nullopt;
  const double size[3] = {largest(of.lower, of.upper).x, largest(of.lower, of.upper).y,
                          largest(of.lower, of.upper).z};
  const double low[3] = {of.lower.x, of.lower.y, of.lower.z};
  const double high[3] = {of.upper.x, of.upper.y, of.upper.z};
  const space::Affine map = in_double(transform);
  double lower[3], upper[3];
  for (std::size_t i = 0; i < 3; ++i) {
    double from = map[i][3], to = map[i][3], at_most = std::fabs(map[i][3]);
    for (std::size_t j = 0; j < 3; ++j) {
      const double a = map[i][j] * low[j], b = map[i][j] * high[j];
      from += std::min(a, b);
      to += std::max(a, b);
      at_most += std::fabs(map[i][j]) * size[j];
    }
    if (!(at_most < 0.25 * static_cast<double>(std::numeric_limits<Real>::max()))) {
      return std::nullopt;
    }
    const double off = at_most * (Rounding<Real>::kUlp + 0x1p-49) + Rounding<Real>::kTiny;
    lower[i] = from - off;
    upper[i] = to + off;
  }
  return Extent{{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}, 0, false};
}

/// The boxes of what is placed, in the scene's filter space, as "triangles" with such boxes.
class PlacedBoxes final : public bvh::Primitives {
 public:
  void add(const bvh::Tree& tree, const space::LocalSpace& space) {
    Vec3<double> lower{1, 1, 1}, upper{-1, -1, -1};
    const auto grow = [&](const MiddleBox& local) {
      const MiddleBox box = space.to_scene(local);
      const Vec3<double>&m = box.middle, &h = box.half;
      lower = {std::min(lower.x, m.x - h.x), std::min(lower.y, m.y - h.y),
               std::min(lower.z, m.z - h.z)};
      upper = {std::max(upper.x, m.x + h.x), std::max(upper.y, m.y + h.y),
               std::max(upper.z, m.z + h.z)};
    };
    if (bvh::is_leaf(tree.root)) {
      grow(middle_box(tree.lower, tree.upper, 1));
    } else {  // tighter than the box of the whole, where that is turned
      const bvh::Node& root = tree.nodes[tree.root];
      for (int i = 0; i < bvh::kWidth && root.child[i] != bvh::kNoChild; ++i) {
        grow(middle_box(root, i));
      }
    }
    // In filter space nothing is beyond 1.
    const auto within = [](double x) { return std::clamp(x, -1.0, 1.0); };
    boxes_.push_back({{within(lower.x), within(lower.y), within(lower.z)},
                      {within(upper.x), within(upper.y), within(upper.z)}});
  }
  [[nodiscard]] std::uint32_t size() const override {
    return static_cast<std::uint32_t>(boxes_.size());
  }
  [[nodiscard]] bvh::Corners corners(std::uint32_t number) const override {
    const Ends& box = boxes_[number];
    return {box.lower, box.upper, box.lower};
  }

 private:
  struct Ends {
    Vec3<double> lower, upper;
  };
  std::vector<Ends> boxes_;
};

WorkOptions without_progress(const WorkOptions& work) {
  return {.threads = work.threads, .stop = work.stop};
}

}  // namespace

template <class Real>
Bottom<Real>::Bottom(const MeshView<Real>& mesh, const BuildOptions& options)
    : geometries(std::span<const MeshView<Real>>(&mesh, 1),
                 {.quality = options.quality, .work = without_progress(options.work)}) {
  if (options.quality == Quality::Compact) geometries.expect_no_copies();
  tree =
      bvh::build(geometries, {.quality = options.quality, .work = without_progress(options.work)},
                 options.quality == Quality::Compact ? bvh::Layout::Compact : bvh::Layout::Full);
}

template <class Real>
TwoLevel<Real>::TwoLevel(std::span<Instance<Real>> instances, std::span<Mesh<Real>> baked,
                         const BuildOptions& options) {
  StopPoll stop(options.work.stop);
  Meshes<Real> meshes;
  bottom_of_.resize(instances.size());
  const auto report = [&](double fraction) {
    if (options.work.progress) options.work.progress(fraction);
  };
  const auto add_bottom = [&](std::size_t i) {
    validate_mesh(instances[i].mesh, i, instances.size());
    bottoms_.push_back(std::make_unique<Bottom<Real>>(instances[i].mesh, options));
  };
  for (std::size_t i = 0; i < instances.size(); ++i) {
    bottom_of_[i] = meshes.number(instances[i].mesh);
    if (bottom_of_[i] == bottoms_.size()) add_bottom(i);
    report(0.8 * static_cast<double>(i + 1) / static_cast<double>(instances.size()));
  }
  // Whoever has no space of its own, or none that is any good, is transformed as in a flat scene.
  const auto bake = [&](std::size_t i) {
    stop.now();
    baked[i].vertices = transformed_vertices<Real>(instances[i], i, options.work);
    instances[i].mesh.vertices = baked[i].vertices;
    instances[i].transform = {};
    bottom_of_[i] = static_cast<std::uint32_t>(bottoms_.size());
    add_bottom(i);
  };
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i].mesh.triangles.empty()) continue;
    if (const auto box = placed_box(*bottoms_[bottom_of_[i]], instances[i].transform)) {
      extent_.include(*box);
    } else {
      bake(i);
      extent_.include(bottoms_.back()->geometries.extent());
    }
  }
  const space::AffineMap scene = space::FilterSpace(extent_.lower, extent_.upper).affine_map(false);
  PlacedBoxes boxes;
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    stop.sometimes();
    const std::size_t count = instances[i].mesh.triangles.size();
    const auto space_of = [&] {
      const Bottom<Real>& bottom = *bottoms_[bottom_of_[i]];
      return space::LocalSpace::make(scene, bottom.geometries.affine_map(),
                                     extent_of(bottom, instances[i].transform));
    };
    if (count != 0) {
      std::optional<space::LocalSpace> space = space_of();
      if (!space && instances[i].transform != Transform<Real>{}) {
        bake(i);
        space = space_of();
      }
      if (!space) {  // far too small beside the scene
        usable_ = false;
        return;
      }
      placed_.push_back({bottom_of_[i], static_cast<std::uint32_t>(first),
                         static_cast<std::uint32_t>(count), *space});
      boxes.add(bottoms_[bottom_of_[i]]->tree, *space);
    }
    first += count;
  }
  if (boxes.size() != 0) build_top(boxes, without_progress(options.work));
  report(1);
}

template <class Real>
TwoLevel<Real>::TwoLevel(const Geometries<Real>& scene,
                         const std::vector<std::vector<std::uint32_t>>& parts,
                         const BuildOptions& options) {
  const BuildOptions quiet{.quality = options.quality, .work = without_progress(options.work)};
  PlacedBoxes boxes;
  for (const std::vector<std::uint32_t>& part : parts) {
    if (part.empty()) continue;
    Extent extent;
    space::AffineMap map;
    bottoms_.push_back(
        std::make_unique<Bottom<Real>>(tree_of_part(scene, part, quiet, extent, map)));
    const auto space = space::LocalSpace::make(
        scene.affine_map(), map,
        {in_double(Transform<Real>{}), largest(extent.lower, extent.upper), 0, 0});
    if (!space) {
      usable_ = false;
      return;
    }
    placed_.push_back({static_cast<std::uint32_t>(placed_.size()), 0, kNone, *space});
    boxes.add(bottoms_.back()->tree, *space);
  }
  build_top(boxes, quiet.work);
}

template <class Real>
void TwoLevel<Real>::build_top(const bvh::Primitives& boxes, const WorkOptions& work) {
  top_ = bvh::build_over_boxes(boxes, work);
  std::vector<Placed> in_order;
  in_order.reserve(placed_.size());
  for (std::uint32_t leaf = 0; leaf < placed_.size(); ++leaf) {
    bvh::LeafNumber& number = bvh::single_number(top_, leaf);
    in_order.push_back(placed_[number]);
    number = leaf;
  }
  placed_ = std::move(in_order);
  for (const auto& bottom : bottoms_) bytes_below_ += bottom->tree.bytes();
}

template <class Real>
Geometries<Real> TwoLevel<Real>::geometries(std::span<const Instance<Real>> instances,
                                            const BuildOptions& options) const {
  std::vector<const Geometries<Real>*> local;
  for (const std::uint32_t bottom : bottom_of_) local.push_back(&bottoms_[bottom]->geometries);
  return {instances, std::move(local), extent_, options};
}

template <class Real>
std::uint64_t TwoLevel<Real>::bytes() const {
  return top_.bytes() + placed_.size() * sizeof(Placed) + bytes_below_;
}

template <class Real>
bool are_to_share(std::span<const Instance<Real>> instances, const BuildOptions& options) {
  // About what vertices and tree take, a triangle.
  constexpr std::uint64_t kTriangle = 56 + sizeof(Vec3<Real>) / 2;
  Meshes<Real> meshes;
  std::uint64_t copies = 0;
  bool several = false;
  for (const Instance<Real>& instance : instances) {
    const std::size_t known = meshes.size();
    if (meshes.number(instance.mesh) == known) continue;
    several |= !instance.mesh.triangles.empty();
    copies += instance.mesh.triangles.size() * kTriangle;
  }
  return several && copies > options.flatten_limit;
}

template struct Bottom<float>;
template struct Bottom<double>;
template class TwoLevel<float>;
template class TwoLevel<double>;
template bool are_to_share(std::span<const Instance<float>>, const BuildOptions&);
template bool are_to_share(std::span<const Instance<double>>, const BuildOptions&);

}  // namespace pierce::scene
