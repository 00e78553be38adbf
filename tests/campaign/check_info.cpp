// SPDX-License-Identifier: Apache-2.0
//
// Degenerate triangles are counted exactly, and closed meshes are told from open ones.
#include <algorithm>

#include "campaign/check.h"
#include "campaign/edge_oracle.h"
#include "campaign/origins.h"
#include "pierce/closed.h"

namespace pierce::campaign {
namespace {

bool has_no_area(const Corners& corners) {
  Scale scale;
  scale.see(corners.a).see(corners.b).see(corners.c);
  const IntVec a = scale.integers(corners.a);
  return is_zero(cross(scale.integers(corners.b) - a, scale.integers(corners.c) - a));
}

template <class Real>
void check_placements(const Case<Real>& made, Tally& tally) {
  for (std::size_t g = 0; g < made.origin.placements.size(); ++g) {
    const auto& [source, transform] = made.origin.placements[g];
    const auto& vertices = made.origin.sources[source].vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vec3<Real>& v = vertices[i];
      if (!std::isfinite(v.x + v.y + v.z)) continue;
      const Vec3<Real> wanted = placed_vertex(transform, v);
      if (!std::isfinite(wanted.x + wanted.y + wanted.z)) continue;
      tally.compare("transformed", wanted, transformed(transform, v),
                    [&] { return std::to_string(i); });
    }
  }
}

template <class Real>
void check_closedness(const Mesh<Real>& mesh, Tally& tally) {
  const EdgeCounts edges(world_of<Real>(std::span(&mesh, 1)));
  const auto found =
      closedness(MeshView<Real>{mesh.vertices, mesh.triangles}, SameVertex::Position);
  const auto at = [] { return std::string("of a mesh"); };
  tally.compare("closedness: even", edges.even, found.even, at);
  tally.compare("closedness: balanced", edges.balanced, found.balanced, at);
  tally.compare("closedness: watertight", edges.watertight, found.watertight, at);
  tally.compare("closedness: watertight_even", edges.watertight_even, found.watertight_even, at);
}

}  // namespace

template <class Real>
void check_info(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                Tally& tally) {
  const auto degenerate = static_cast<std::uint64_t>(
      std::count_if(world.begin(), world.end(),
                    [](const Placed& placed) { return has_no_area(placed.corners); }));
  for (const auto& built : scenes) {
    const SceneInfo info = built.scene.info();
    const auto at = [&] { return built.name; };
    tally.compare("info: triangles", std::uint64_t{world.size()}, info.triangles, at);
    tally.compare("info: degenerate", degenerate, info.degenerate, at);
  }
  for (const auto& mesh : made.meshes) check_closedness(mesh, tally);
  check_placements(made, tally);
}

template void check_info(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_info(const Case<double>&, const Scenes<double>&, const World&, Tally&);

}  // namespace pierce::campaign
