// SPDX-License-Identifier: Apache-2.0
//
// The closedness test: all edges by their smaller vertex, then a look at each vertex's few edges.
#include "pierce/closed.h"

#include <algorithm>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/boundary.h"
#include "mesh/edge_table.h"
#include "mesh/pieces.h"
#include "support/float_environment.h"
#include "support/parallel.h"
#include "support/stop_poll.h"

namespace pierce {
namespace {

using mesh::earlier;
using mesh::EdgeTable;
using mesh::Use;

template <class Real>
void check_indices(MeshView<Real> mesh) {
  std::uint64_t bad = 0;
  std::size_t first = 0;
  for (std::size_t i = mesh.triangles.size(); i-- > 0;) {
    const Triangle& t = mesh.triangles[i];
    if (std::max({t[0], t[1], t[2]}) < mesh.vertices.size()) continue;
    ++bad;
    first = i;
  }
  if (bad == 0) return;
  throw Error(ErrorCode::IndexOutOfRange,
              "triangle " + std::to_string(first) + " names a vertex that does not exist (" +
                  std::to_string(bad) + " such triangles; the mesh has " +
                  std::to_string(mesh.vertices.size()) + " vertices)",
              first, bad);
}

// The edges that are wrong are remembered as their first use, for the order; EdgeUse comes later.
struct Finding {
  EdgeUse edge;
  Use first;
};

void keep_earlier(std::optional<Finding>& kept, const std::optional<Finding>& found) {
  if (found && (!kept || earlier(found->first, kept->first))) kept = found;
}

struct Tally {
  Closedness counts;
  std::optional<Finding> unbalanced, odd, crowded;

  void add_edge(std::span<const Triangle> triangles, std::span<const Use> uses);
  void join(const Tally& other);
};

void Tally::add_edge(std::span<const Triangle> triangles, std::span<const Use> uses) {
  ++counts.edges;
  const auto up = static_cast<std::uint64_t>(
      std::count_if(uses.begin(), uses.end(), [](const Use& use) { return use.upward; }));
  const std::uint64_t down = uses.size() - up;
  if (up == 1 && down == 1) return;

  const Use& first = uses.front();
  const Triangle& t = triangles[first.triangle];
  EdgeUse edge{first.triangle, t[first.corner], t[(first.corner + 1U) % 3U]};
  if (uses.size() > 1) edge.other_triangle = uses[1].triangle;
  edge.forward = first.upward ? up : down;
  edge.backward = first.upward ? down : up;

  counts.open_edges += uses.size() == 1;
  if (uses.size() % 2 != 0) {
    ++counts.odd_edges;
    keep_earlier(odd, Finding{edge, first});
  }
  (up == down ? counts.crowded_edges : counts.unbalanced_edges) += 1;
  keep_earlier(up == down ? crowded : unbalanced, Finding{edge, first});
}

void Tally::join(const Tally& other) {
  counts.edges += other.counts.edges;
  counts.open_edges += other.counts.open_edges;
  counts.unbalanced_edges += other.counts.unbalanced_edges;
  counts.odd_edges += other.counts.odd_edges;
  counts.crowded_edges += other.counts.crowded_edges;
  keep_earlier(unbalanced, other.unbalanced);
  keep_earlier(odd, other.odd);
  keep_earlier(crowded, other.crowded);
}

template <class Visit>  // visit(all uses of an edge), in a group that is sorted by other vertex
void for_each_edge(std::span<const Use> group, const Visit& visit) {
  for (std::size_t i = 0, next = 0; i < group.size(); i = next) {
    while (next < group.size() && group[next].other == group[i].other) ++next;
    visit(group.subspan(i, next - i));
  }
}

// Tallies the edges whose smaller vertex lies in the range, sorting each group by other vertex.
Tally tally_vertices(std::span<const Triangle> triangles, EdgeTable& table, std::size_t begin,
                     std::size_t end, const scene::StopPoll& stop) {
  Tally tally;
  for (std::size_t v = begin; v < end; ++v) {
    const std::span<Use> group = table.group(v);
    std::sort(group.begin(), group.end(), [&stop](const Use& a, const Use& b) {
      stop.now();
      return a.other != b.other ? a.other < b.other : earlier(a, b);
    });
    for_each_edge(group, [&](std::span<const Use> uses) { tally.add_edge(triangles, uses); });
  }
  return tally;
}

// Edges at fault that may yet pair up in pieces, each with what is told of it.
struct LooseEdges {
  std::vector<mesh::LooseEdge> edges;
  std::vector<Finding> findings;

  // Takes out those whose pieces pair; returns how many, and the first of the others.
  template <class Real>
  std::pair<std::uint64_t, std::optional<Finding>> settle(std::span<const Vec3<Real>> vertices,
                                                          mesh::Pieces what,
                                                          const scene::StopPoll& stop) const {
    const auto paired = mesh::pairs_in_pieces(edges, vertices, what, stop);
    std::uint64_t count = 0;
    std::optional<Finding> first;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      count += paired[i];
      if (paired[i] == 0) keep_earlier(first, findings[i]);
    }
    return {count, first};
  }
};

// T-junctions: the table is that of positions, its groups sorted.
template <class Real>
void settle_pieces(MeshView<Real> mesh, EdgeTable& table, Closedness& counts, Tally& tally,
                   const scene::StopPoll& stop) {
  LooseEdges unbalanced, odd;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    for_each_edge(table.group(v), [&](std::span<const Use> uses) {
      stop.now();
      Tally one;
      one.add_edge(mesh.triangles, uses);
      std::int64_t surplus = 0;
      for (const Use& use : uses) surplus += use.upward ? 1 : -1;
      if (one.unbalanced) {
        unbalanced.edges.push_back({v, uses.front().other, surplus});
        unbalanced.findings.push_back(*one.unbalanced);
      }
      if (one.odd) {
        odd.edges.push_back({v, uses.front().other, surplus});
        odd.findings.push_back(*one.odd);
      }
    });
  }
  const auto [in_pieces, first] = unbalanced.settle(mesh.vertices, mesh::Pieces::Balanced, stop);
  counts.unbalanced_in_pieces = in_pieces;
  if (first) tally.unbalanced = first;
  if (odd.edges.empty()) return;
  const auto [odd_in_pieces, first_odd] = odd.settle(mesh.vertices, mesh::Pieces::Even, stop);
  counts.odd_in_pieces = odd_in_pieces;
  if (first_odd) tally.odd = first_odd;
}

template <class Real>
Closedness closedness_here(MeshView<Real> surface, SameVertex same, const scene::StopPoll& stop) {
  check_indices(surface);
  EdgeTable table = mesh::sort_edges(surface.triangles, surface.vertices.size(),
                                     mesh::representatives(surface, same, stop), stop);

  Tally tally = parallel::reduce(
      std::size_t{0}, surface.vertices.size(), 4096, Tally{},
      [&](std::size_t first, std::size_t last) {
        return tally_vertices(surface.triangles, table, first, last, stop);
      },
      [](Tally a, const Tally& b) {
        a.join(b);
        return a;
      });

  Closedness result = tally.counts;
  if (same == SameVertex::Position && result.unbalanced_edges != 0) {
    settle_pieces(surface, table, result, tally, stop);
  }
  result.balanced = result.unbalanced_edges == 0;
  result.even = result.odd_edges == 0;
  result.closed = result.balanced && result.crowded_edges == 0;
  result.watertight = result.unbalanced_edges == result.unbalanced_in_pieces;
  result.watertight_even = result.odd_edges == result.odd_in_pieces;
  if (tally.unbalanced) result.first_unbalanced = tally.unbalanced->edge;
  if (tally.odd) result.first_odd = tally.odd->edge;
  if (tally.crowded) result.first_crowded = tally.crowded->edge;
  return result;
}

}  // namespace

template <class Real>
Closedness closedness(MeshView<Real> mesh, SameVertex same, const WorkOptions& work) {
  const FloatEnvironment environment;
  const scene::StopPoll stop(work.stop);
  return parallel::with_threads(work.threads, [&] { return closedness_here(mesh, same, stop); });
}

template <class Real>
std::vector<mesh::OpenEdge> mesh::open_edges(MeshView<Real> mesh, const WorkOptions& work) {
  const scene::StopPoll stop(work.stop);
  return parallel::with_threads(work.threads, [&] {
    EdgeTable table = sort_edges(mesh.triangles, mesh.vertices.size(),
                                 representatives(mesh, SameVertex::Position, stop), stop);
    std::vector<OpenEdge> open;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const std::span<Use> group =
          std::span(table.uses).subspan(table.start[v], table.start[v + 1] - table.start[v]);
      std::sort(group.begin(), group.end(),
                [](const Use& a, const Use& b) { return a.other < b.other; });
      for (std::size_t i = 0; i < group.size();) {
        stop.now();
        std::int64_t upward = 0;
        const std::uint32_t other = group[i].other;
        for (; i < group.size() && group[i].other == other; ++i) upward += group[i].upward ? 1 : -1;
        if (upward > 0) open.push_back({v, other, static_cast<std::uint32_t>(upward)});
        if (upward < 0) open.push_back({other, v, static_cast<std::uint32_t>(-upward)});
      }
    }
    return open;
  });
}

template Closedness closedness(MeshView<float>, SameVertex, const WorkOptions&);
template Closedness closedness(MeshView<double>, SameVertex, const WorkOptions&);
template std::vector<mesh::OpenEdge> mesh::open_edges(MeshView<float>, const WorkOptions&);
template std::vector<mesh::OpenEdge> mesh::open_edges(MeshView<double>, const WorkOptions&);

}  // namespace pierce
