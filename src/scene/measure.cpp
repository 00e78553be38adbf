// SPDX-License-Identifier: Apache-2.0
//
// Measures of a mesh: its size, and how its triangles hang together.
#include "pierce/measure.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "mesh/edge_table.h"
#include "mesh/size.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"
#include "support/parallel.h"

namespace pierce {
namespace {

// Sets that grow together, each member with a parity against its set's first one.
class ParitySets {
 public:
  explicit ParitySets(std::size_t count) : above_(count), odd_(count) {
    std::iota(above_.begin(), above_.end(), 0U);
  }

  struct Place {
    std::uint32_t root;
    bool odd;
  };
  Place find(std::uint32_t x) {
    std::uint32_t root = x;
    bool odd = false;
    for (; above_[root] != root; root = above_[root]) odd ^= odd_[root];
    const Place place{root, odd};
    while (above_[x] != root && x != root) {  // straight to the root from now on
      const std::uint32_t next = above_[x];
      const bool rest = odd ^ odd_[x];
      above_[x] = root;
      odd_[x] = odd;
      x = next;
      odd = rest;
    }
    return place;
  }
  /// False if they are in one set and the parity contradicts.
  bool join(std::uint32_t x, std::uint32_t y, bool odd) {
    const Place a = find(x), b = find(y);
    if (a.root == b.root) return (a.odd ^ b.odd) == odd;
    above_[b.root] = a.root;
    odd_[b.root] = a.odd ^ b.odd ^ odd;
    return true;
  }

 private:
  std::vector<std::uint32_t> above_;
  std::vector<bool> odd_;
};

void look_at_edges(mesh::EdgeTable& table, std::span<const Triangle> triangles,
                   const scene::StopPoll& stop, MeshMeasures& found) {
  const std::size_t vertices = table.start.size() - 1;
  ParitySets connected(vertices), sides(triangles.size());
  std::vector<bool> used(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    stop.now();
    const std::span<mesh::Use> group =
        std::span(table.uses).subspan(table.start[v], table.start[v + 1] - table.start[v]);
    std::sort(group.begin(), group.end(), [](const mesh::Use& a, const mesh::Use& b) {
      return a.other != b.other ? a.other < b.other : mesh::earlier(a, b);
    });
    for (std::size_t i = 0; i < group.size();) {
      std::size_t end = i + 1;
      while (end < group.size() && group[end].other == group[i].other) ++end;
      ++found.edges;
      used[v] = used[group[i].other] = true;
      connected.join(v, group[i].other, false);
      if (end - i == 2) {
        const bool against = group[i].upward == group[i + 1].upward;
        found.consistent &= !against;
        found.orientable &= sides.join(group[i].triangle, group[i + 1].triangle, against);
      }
      i = end;
    }
  }
  found.triangles = table.uses.size() / 3;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (!used[v]) continue;
    ++found.vertices;
    found.components += connected.find(v).root == v;
  }
  found.euler = static_cast<std::int64_t>(found.vertices + found.triangles) -
                static_cast<std::int64_t>(found.edges);
}

}  // namespace

template <class Real>
MeshMeasures measure(MeshView<Real> surface, SameVertex same, const WorkOptions& work) {
  const FloatEnvironment environment;
  scene::validate_mesh(surface, 0, 1);
  const scene::StopPoll stop(work.stop);
  return parallel::with_threads(work.threads, [&] {
    MeshMeasures found;
    const mesh::Size size = mesh::size_of(surface, work);
    found.volume = size.volume;
    found.area = size.area;
    mesh::EdgeTable table = mesh::sort_edges(surface.triangles, surface.vertices.size(),
                                             mesh::representatives(surface, same, stop), stop);
    look_at_edges(table, surface.triangles, stop, found);
    return found;
  });
}

template MeshMeasures measure(MeshView<float>, SameVertex, const WorkOptions&);
template MeshMeasures measure(MeshView<double>, SameVertex, const WorkOptions&);

}  // namespace pierce
