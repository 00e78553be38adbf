// SPDX-License-Identifier: Apache-2.0
//
// The edges of a mesh, a counting sort of all uses by their smaller vertex. Nothing is rounded:
// positions are compared as numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "mesh/positions.h"
#include "pierce/closed.h"
#include "support/parallel.h"
#include "support/stop_poll.h"

namespace pierce::mesh {

// One use of an edge by a triangle, kept with the smaller of its two vertices.
struct Use {
  std::uint32_t other;     // the larger vertex
  std::uint32_t triangle;  // whose edge it is
  std::uint8_t corner;     // where in the triangle the edge starts
  bool upward;             // runs from the smaller vertex to the larger
};

using Representatives = std::vector<std::uint32_t>;  // vertex -> the first one at its position

template <class Real>
Representatives representatives(MeshView<Real> mesh, SameVertex same, const scene::StopPoll& stop) {
  if (same == SameVertex::Position) return first_at_position(mesh.vertices, stop);
  return {};
}

// All uses of edges, grouped by smaller vertex; within a group in order of triangles.
struct EdgeTable {
  std::vector<std::size_t> start;  // of each vertex's group; one more than there are vertices
  std::vector<Use> uses;

  std::span<Use> group(std::size_t vertex) {
    return std::span(uses).subspan(start[vertex], start[vertex + 1] - start[vertex]);
  }
};

template <class Visit>  // visit(smaller vertex, use)
void for_each_use(std::span<const Triangle> triangles, const Representatives& same,
                  const scene::StopPoll& stop, Visit visit) {
  const auto of = [&](std::uint32_t v) { return same.empty() ? v : same[v]; };
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    stop.now();
    const Triangle t = {of(triangles[i][0]), of(triangles[i][1]), of(triangles[i][2])};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1U) % 3U];
      visit(std::min(from, to),
            Use{std::max(from, to), static_cast<std::uint32_t>(i), k, from < to});
    }
  }
}

inline EdgeTable sort_edges(std::span<const Triangle> triangles, std::size_t vertices,
                            const Representatives& same, const scene::StopPoll& stop) {
  EdgeTable table;
  table.start.assign(vertices + 1, 0);
  for_each_use(triangles, same, stop, [&](std::uint32_t v, const Use&) { ++table.start[v + 1]; });
  std::partial_sum(table.start.begin(), table.start.end(), table.start.begin());
  table.uses.resize(table.start.back());
  std::vector<std::size_t> next(table.start.begin(), table.start.end() - 1);
  for_each_use(triangles, same, stop,
               [&](std::uint32_t v, const Use& use) { table.uses[next[v]++] = use; });
  return table;
}

inline bool earlier(const Use& a, const Use& b) {
  return std::tie(a.triangle, a.corner) < std::tie(b.triangle, b.corner);
}

}  // namespace pierce::mesh
