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

// Equal positions get the same representative. NaN positions are equal to nothing.
template <class Real>
Representatives match_positions(std::span<const Vec3<Real>> vertices, const scene::StopPoll& stop) {
  struct Placed {
    Vec3<Real> at;
    std::uint32_t vertex;
  };
  std::vector<Placed> sorted(vertices.size());
  parallel::for_ranges(std::size_t{0}, vertices.size(), 4096,
                       [&](std::size_t first, std::size_t last) {
                         for (std::size_t i = first; i != last; ++i) {
                           const Vec3<Real>& v = vertices[i];
                           // x + 0 turns -0 into 0 and NaN would break the order, so it takes a
                           // place of its own.
                           sorted[i] = {{v.x + 0, v.y + 0, v.z + 0}, static_cast<std::uint32_t>(i)};
                         }
                       });
  const auto is_number = [](const Placed& p) {
    return p.at.x == p.at.x && p.at.y == p.at.y && p.at.z == p.at.z;
  };
  const auto end = std::partition(sorted.begin(), sorted.end(), is_number);
  parallel::sort(sorted.begin(), end, [&stop](const Placed& a, const Placed& b) {
    stop.now();
    return std::tie(a.at.x, a.at.y, a.at.z, a.vertex) < std::tie(b.at.x, b.at.y, b.at.z, b.vertex);
  });

  Representatives result(vertices.size());
  std::iota(result.begin(), result.end(), 0U);
  for (auto it = sorted.begin(); it != end; ++it) {
    stop.now();
    if (it != sorted.begin() && std::prev(it)->at == it->at) {
      result[it->vertex] = result[std::prev(it)->vertex];
    }
  }
  return result;
}

template <class Real>
Representatives representatives(MeshView<Real> mesh, SameVertex same, const scene::StopPoll& stop) {
  if (same == SameVertex::Position) return match_positions(mesh.vertices, stop);
  return {};
}

// All uses of edges, grouped by smaller vertex; within a group in order of triangles.
struct EdgeTable {
  std::vector<std::size_t> start;  // of each vertex's group; one more than there are vertices
  std::vector<Use> uses;
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
