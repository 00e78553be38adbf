// SPDX-License-Identifier: Apache-2.0
#include "scene/points/surface.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pierce/closed.h"
#include "support/count_words.h"
#include "support/stop_poll.h"

namespace pierce::scene {
namespace {

std::string triangle_text(const TriangleRef& ref, bool several) {
  std::string text = "triangle " + std::to_string(ref.triangle);
  if (several) text += " of geometry " + std::to_string(ref.geometry);
  return text;
}

// Geometries as one mesh.
template <class Real>
class OneMesh {
 public:
  OneMesh(const Geometries<Real>& geometries, std::vector<std::uint32_t> which,
          const StopPoll& stop)
      : which_(std::move(which)) {
    const auto meshes = geometries.meshes();
    std::uint64_t count = 0;
    for (const std::uint32_t i : which_) count += meshes[i].vertices.size();
    if (count >= kNone) {
      throw Error(ErrorCode::TooManyTriangles,
                  "too many vertices to see whether the surface is closed: " +
                      std::to_string(count) + ", at most " + std::to_string(kNone - 1) +
                      " will do; go on with the open-mesh option");
    }
    for (const std::uint32_t i : which_) {
      const auto first = static_cast<std::uint32_t>(vertices_.size());
      first_vertex_.push_back(first);
      first_triangle_.push_back(static_cast<std::uint32_t>(triangles_.size()));
      for (std::uint32_t k = 0; k < meshes[i].vertices.size(); ++k) {
        vertices_.push_back(geometries.vertex(i, k));
      }
      for (const Triangle& t : meshes[i].triangles) {
        stop.now();
        triangles_.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
  }

  [[nodiscard]] MeshView<Real> view() const { return {vertices_, triangles_}; }
  [[nodiscard]] TriangleRef ref(std::uint32_t triangle) const {
    const std::size_t i = part_of(triangle);
    return {which_[i], triangle - first_triangle_[i]};
  }
  /// The number that the first vertex of the triangle's geometry has here.
  [[nodiscard]] std::uint32_t first_vertex(std::uint32_t triangle) const {
    return first_vertex_[part_of(triangle)];
  }

 private:
  [[nodiscard]] std::size_t part_of(std::uint32_t triangle) const {
    const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
    return static_cast<std::size_t>(next - first_triangle_.begin()) - 1;
  }

  std::vector<std::uint32_t> which_;
  std::vector<Vec3<Real>> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> first_vertex_, first_triangle_;  // one each
};

// What has to be looked at together: all geometries, but of those that share a mesh none whose mesh
// is closed by itself. Where it stands its edges are used as they are in itself, and that changes
// nothing about anybody's.
template <class Real>
std::vector<std::uint32_t> open_geometries(const Geometries<Real>& geometries,
                                           const WorkOptions& work) {
  std::vector<std::uint32_t> open;
  std::map<std::pair<const void*, const void*>, bool> closed;  // by where a mesh's arrays lie
  const auto meshes = geometries.meshes();
  for (std::uint32_t i = 0; i < meshes.size(); ++i) {
    if (geometries.shares_meshes()) {
      const auto [known, is_new] =
          closed.try_emplace({meshes[i].vertices.data(), meshes[i].triangles.data()});
      if (is_new) {
        const Closedness found = closedness(meshes[i], SameVertex::Position, work);
        known->second = found.even && found.balanced;
      }
      if (known->second) continue;
    }
    open.push_back(i);
  }
  return open;
}

// "edge 3-7 of triangle 12 belongs to no other triangle"
template <class Real>
std::string describe(const EdgeUse& edge, const OneMesh<Real>* together, bool several) {
  const auto ref = [&](std::uint32_t triangle) {
    return together != nullptr ? together->ref(triangle) : TriangleRef{0, triangle};
  };
  const std::uint32_t first = together != nullptr ? together->first_vertex(edge.triangle) : 0;
  const std::string text = "edge " + std::to_string(edge.from - first) + "-" +
                           std::to_string(edge.to - first) + " of " +
                           triangle_text(ref(edge.triangle), several);
  if (edge.other_triangle == kNone) return text + " belongs to no other triangle";
  return text + " is used " + times(edge.forward) + " that way and " + times(edge.backward) +
         " the other way (also by " + triangle_text(ref(edge.other_triangle), several) + ")";
}

std::string first_of(std::uint64_t count) {
  return count == 1 ? " (the only such edge)"
                    : " (the first of " + std::to_string(count) + " such edges)";
}

std::uint64_t leaf_entries(const bvh::Tree& tree) {
  if (tree.root == bvh::kNoChild) return 0;
  if (bvh::is_leaf(tree.root)) return bvh::leaf_count(tree.root);
  std::uint64_t entries = 0;
  for (const bvh::Node& node : tree.nodes) {
    for (const std::uint32_t child : node.child) {
      if (bvh::is_leaf(child)) entries += bvh::leaf_count(child);
    }
  }
  return entries;
}

}  // namespace

template <class Real>
Surface examine_surface(const Geometries<Real>& geometries, const WorkOptions& work) {
  const auto meshes = geometries.meshes();
  std::optional<OneMesh<Real>> together;
  if (meshes.size() != 1 || geometries.shares_meshes()) {
    together.emplace(geometries, open_geometries(geometries, work), StopPoll(work.stop));
  }
  const Closedness found =
      closedness(together ? together->view() : meshes[0], SameVertex::Position, work);
  const auto text = [&](const EdgeUse& edge) {
    return describe<Real>(edge, together ? &*together : nullptr, meshes.size() > 1);
  };
  const auto error = [&](const std::string& fault, const EdgeUse& edge, std::uint64_t count,
                         const std::string& cure) {
    return Error(ErrorCode::NotClosed,
                 fault + ": " + text(edge) + first_of(count) + "; " + cure +
                     ", or go on regardless with the open-mesh option",
                 together ? together->ref(edge.triangle).triangle : edge.triangle, count);
  };
  const std::string open = "the surface is not closed", close = "close it";
  Surface surface;
  if (!found.even) surface.odd = error(open, *found.first_odd, found.odd_edges, close);
  if (!found.balanced) {
    const auto [fault, cure] = found.even ? std::pair("the triangles do not all face the same way",
                                                      "turn them, or take the rule Odd")
                                          : std::pair(open.c_str(), close.c_str());
    surface.unbalanced = error(fault, *found.first_unbalanced, found.unbalanced_edges, cure);
  }
  return surface;
}

void validate_closed(const Surface& surface, InsideRule rule) {
  const std::optional<Error>& fault = rule == InsideRule::Odd ? surface.odd : surface.unbalanced;
  if (fault) throw Error(*fault);
}

template <class Real>
const Surface& LazySurface::of(const Geometries<Real>& geometries, const WorkOptions& work) {
  const WorkOptions quiet{.threads = work.threads, .stop = work.stop};
  // In an arena of its own: a thread that waits for the others in the midst of this must not take
  // up a task of the caller that asks the same.
  examined_.call([&] { surface_ = examine_surface(geometries, quiet); },
                 [&] { StopPoll(work.stop).now(); });
  return surface_;
}

bool LazySurface::repeats(const bvh::Tree& tree, std::uint32_t triangles) {
  counted_.call([&] { repeats_ = leaf_entries(tree) != triangles; }, [] {});
  return repeats_;
}

template Surface examine_surface(const Geometries<float>&, const WorkOptions&);
template Surface examine_surface(const Geometries<double>&, const WorkOptions&);
template const Surface& LazySurface::of(const Geometries<float>&, const WorkOptions&);
template const Surface& LazySurface::of(const Geometries<double>&, const WorkOptions&);

}  // namespace pierce::scene
