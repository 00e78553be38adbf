// SPDX-License-Identifier: Apache-2.0
#include "mesh/coincident.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "mesh/positions.h"
#include "support/parallel.h"

namespace pierce::mesh {
namespace {

// A triangle by the positions of its corners, in ascending order.
struct Placed {
  Triangle corners;
  std::uint32_t number;
  bool turned;  // putting them in order took an odd number of exchanges
};

Placed placed(Triangle corners, std::uint32_t number) {
  bool turned = false;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (corners[i] <= corners[j]) return;
    std::swap(corners[i], corners[j]);
    turned = !turned;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return {corners, number, turned};
}

}  // namespace

template <class Real>
Coincident coincident_triangles(MeshView<Real> mesh, const scene::StopPoll& stop) {
  const std::vector<std::uint32_t> first = first_at_position(mesh.vertices, stop);
  std::vector<Placed> all;
  all.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    stop.now();
    const Triangle& t = mesh.triangles[i];
    all.push_back(placed({first[t[0]], first[t[1]], first[t[2]]}, i));
  }
  parallel::sort(all.begin(), all.end(), [&stop](const Placed& a, const Placed& b) {
    stop.now();
    return std::tie(a.corners, a.number) < std::tie(b.corners, b.number);
  });
  Coincident result;
  for (std::size_t i = 0, next = 0; i < all.size(); i = next) {
    std::array<std::uint64_t, 2> ways{};
    const Triangle& corners = all[i].corners;
    for (; next < all.size() && all[next].corners == corners; ++next) {
      if (next != i) result.repeats.push_back(all[next].number);
      ++ways[all[next].turned ? 1 : 0];
    }
    const bool vertex_repeats = corners[0] == corners[1] || corners[1] == corners[2];
    if (!vertex_repeats) result.cancelling += 2 * std::min(ways[0], ways[1]);
  }
  std::sort(result.repeats.begin(), result.repeats.end());
  return result;
}

template Coincident coincident_triangles(MeshView<float>, const scene::StopPoll&);
template Coincident coincident_triangles(MeshView<double>, const scene::StopPoll&);

}  // namespace pierce::mesh
