// SPDX-License-Identifier: Apache-2.0
#include "scene/points/surface.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pierce/closed.h"
#include "scene/points/one_mesh.h"
#include "support/count_words.h"
#include "support/stop_poll.h"

namespace pierce::scene {
namespace {

std::string triangle_text(const TriangleRef& ref, bool several) {
  std::string text = "triangle " + std::to_string(ref.triangle);
  if (several) text += " of geometry " + std::to_string(ref.geometry);
  return text;
}

// "edge 3-7 of triangle 12 belongs to no other triangle"
template <class Real>
std::string describe(const EdgeUse& edge, const Geometries<Real>& geometries,
                     const std::vector<std::uint32_t>& first_vertex) {
  const bool several = geometries.meshes().size() > 1;
  const TriangleRef ref = geometries.ref(edge.triangle);
  const std::uint32_t first = several ? first_vertex[ref.geometry] : 0;
  const std::string text = "edge " + std::to_string(edge.from - first) + "-" +
                           std::to_string(edge.to - first) + " of " + triangle_text(ref, several);
  if (edge.other_triangle == kNone) return text + " belongs to no other triangle";
  return text + " is used " + times(edge.forward) + " that way and " + times(edge.backward) +
         " the other way (also by " + triangle_text(geometries.ref(edge.other_triangle), several) +
         ")";
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
  if (meshes.size() != 1) {
    together.emplace(meshes, StopPoll(work.stop), "see whether the surface is closed",
                     "; go on with the open-mesh option");
  }
  const MeshView<Real> mesh =
      together ? MeshView<Real>{together->vertices, together->triangles} : meshes[0];
  const Closedness found = closedness(mesh, SameVertex::Position, work);
  const auto text = [&](const EdgeUse& edge) {
    return describe(edge, geometries,
                    together ? together->first_vertex : std::vector<std::uint32_t>{});
  };
  const auto error = [&](const std::string& fault, const EdgeUse& edge, std::uint64_t count,
                         const std::string& cure) {
    return Error(ErrorCode::NotClosed,
                 fault + ": " + text(edge) + first_of(count) + "; " + cure +
                     ", or go on regardless with the open-mesh option",
                 geometries.ref(edge.triangle).triangle, count);
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
