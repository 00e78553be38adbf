// SPDX-License-Identifier: Apache-2.0
#include "scene/points/surface.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/coincident.h"
#include "pierce/closed.h"
#include "scene/points/one_mesh.h"
#include "support/count_words.h"
#include "support/parallel.h"
#include "support/stop_poll.h"

namespace pierce::scene {
namespace {

constexpr const char* kSeeWhetherClosed = "see whether the surface is closed";
constexpr const char* kGoOn = "; go on with the open-mesh option";

std::string triangle_text(const TriangleRef& ref, bool several) {
  std::string text = "triangle " + std::to_string(ref.triangle);
  if (several) text += " of geometry " + std::to_string(ref.geometry);
  return text;
}

// What has to be looked at together: all geometries, but of those that share a mesh none whose mesh
// is closed by itself. Where it stands its edges are used as they are in itself, and that changes
// nothing about anybody's.
template <class Real>
std::vector<std::uint32_t> open_geometries(const Geometries<Real>& geometries,
                                           const WorkOptions& work) {
  const auto meshes = geometries.meshes();
  if (!geometries.shares_meshes()) return all_of(meshes.size());
  std::vector<std::uint32_t> open;
  std::map<std::pair<const void*, const void*>, bool> closed;  // by where a mesh's arrays lie
  for (std::uint32_t i = 0; i < meshes.size(); ++i) {
    const auto [known, is_new] =
        closed.try_emplace({meshes[i].vertices.data(), meshes[i].triangles.data()});
    if (is_new) {
      const Closedness found = closedness(meshes[i], SameVertex::Position, work);
      known->second = found.even && found.balanced;
    }
    if (!known->second) open.push_back(i);
  }
  return open;
}

// Edges of one mesh that was made of all geometries, or of some of their triangles, in words.
template <class Real>
struct EdgeWords {
  const Geometries<Real>& geometries;
  std::span<const std::uint32_t> first_vertex;  // of each geometry; none if there is only one
  std::span<const std::uint32_t> primitives;    // of each triangle; none if they are the same

  [[nodiscard]] TriangleRef ref(std::uint32_t triangle) const {
    return geometries.ref(primitives.empty() ? triangle : primitives[triangle]);
  }

  // "edge 3-7 of triangle 12 belongs to no other triangle"
  [[nodiscard]] std::string operator()(const EdgeUse& edge) const {
    const bool several = geometries.meshes().size() > 1;
    const TriangleRef first = ref(edge.triangle);
    const std::uint32_t before = several ? first_vertex[first.geometry] : 0;
    const std::string text = "edge " + std::to_string(edge.from - before) + "-" +
                             std::to_string(edge.to - before) + " of " +
                             triangle_text(first, several);
    if (edge.other_triangle == kNone) return text + " belongs to no other triangle";
    return text + " is used " + times(edge.forward) + " that way and " + times(edge.backward) +
           " the other way (also by " + triangle_text(ref(edge.other_triangle), several) + ")";
  }
};

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

// Why the rules mean nothing for a surface, unless they do.
template <class Real>
Surface faults_of(const Closedness& found, const EdgeWords<Real>& words) {
  const auto error = [&](const std::string& fault, const EdgeUse& edge, std::uint64_t count,
                         const std::string& cure) {
    return Error(ErrorCode::NotClosed,
                 fault + ": " + words(edge) + first_of(count) + "; " + cure +
                     ", or go on regardless with the open-mesh option",
                 words.ref(edge.triangle).triangle, count);
  };
  const std::string open = "the surface is not closed", close = "close it";
  Surface surface;
  if (!found.watertight_even) {
    surface.odd = error(open, *found.first_odd, found.odd_edges - found.odd_in_pieces, close);
  }
  if (!found.watertight) {
    const auto [fault, cure] = found.watertight_even
                                   ? std::pair("the triangles do not all face the same way",
                                               "turn them, or take the rule Odd")
                                   : std::pair(open.c_str(), close.c_str());
    surface.unbalanced = error(fault, *found.first_unbalanced,
                               found.unbalanced_edges - found.unbalanced_in_pieces, cure);
  }
  return surface;
}

}  // namespace

template <class Real>
Surface examine_surface(const Geometries<Real>& geometries, const WorkOptions& work) {
  geometries.examine();
  const auto meshes = geometries.meshes();
  if (meshes.size() == 1 && !geometries.shares_meshes()) {
    return faults_of<Real>(closedness(meshes[0], SameVertex::Position, work), {geometries, {}, {}});
  }
  const OneMesh<Real> together(geometries, open_geometries(geometries, work), StopPoll(work.stop),
                               kSeeWhetherClosed, kGoOn);
  return faults_of<Real>(closedness(together.view(), SameVertex::Position, work),
                         {geometries, together.first_vertex, together.primitives});
}

template <class Real>
Unrepeated<Real> leave_out_repeats(const Geometries<Real>& geometries, const WorkOptions& work) {
  const StopPoll stop(work.stop);
  OneMesh<Real> together(geometries, all_of(geometries.meshes().size()), stop, kSeeWhetherClosed,
                         kGoOn);
  const std::vector<std::uint32_t> repeats = parallel::with_threads(
      work.threads, [&] { return mesh::coincident_triangles(together.view(), stop).repeats; });
  Unrepeated<Real> result;
  if (repeats.empty()) return result;

  std::vector<std::uint32_t> kept;  // primitive numbers
  result.triangles.resize(geometries.meshes().size());
  auto repeat = repeats.begin();
  for (std::uint32_t i = 0; i < geometries.size(); ++i) {
    stop.now();
    if (repeat != repeats.end() && *repeat == i) {
      ++repeat;
      continue;
    }
    const auto [geometry, triangle] = geometries.ref(i);
    result.triangles[geometry].push_back(geometries.meshes()[geometry].triangles[triangle]);
    together.triangles[kept.size()] = together.triangles[i];
    kept.push_back(i);
  }
  together.triangles.resize(kept.size());
  const Closedness found = closedness(together.view(), SameVertex::Position, work);
  result.fault = faults_of<Real>(found, {geometries, together.first_vertex, kept}).odd;
  result.vertices.resize(geometries.meshes().size());
  for (std::uint32_t g = 0; g < geometries.meshes().size(); ++g) {
    std::span<const Vec3<Real>> vertices = geometries.meshes()[g].vertices;
    if (geometries.is_placed(g)) {
      for (std::uint32_t k = 0; k < vertices.size(); ++k) {
        result.vertices[g].push_back(geometries.vertex(g, k));
      }
      vertices = result.vertices[g];
    }
    result.views.push_back({vertices, result.triangles[g]});
  }
  return result;
}

void validate_closed(const Surface& surface, InsideRule rule) {
  const std::optional<Error>& fault =
      rule == InsideRule::NonZero ? surface.unbalanced : surface.odd;
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
template Unrepeated<float> leave_out_repeats(const Geometries<float>&, const WorkOptions&);
template Unrepeated<double> leave_out_repeats(const Geometries<double>&, const WorkOptions&);
template const Surface& LazySurface::of(const Geometries<float>&, const WorkOptions&);
template const Surface& LazySurface::of(const Geometries<double>&, const WorkOptions&);

}  // namespace pierce::scene
