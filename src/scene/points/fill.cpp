// SPDX-License-Identifier: Apache-2.0
#include "scene/points/fill.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "mesh/boundary.h"
#include "predicate/settle.h"
#include "scene/points/one_mesh.h"
#include "scene/points/winding_tree.h"

namespace pierce::scene {
namespace {

using mesh::OpenEdge;

// Open edges put together to loops that pass no vertex twice. `emit(vertices)` for each.
class Loops {
 public:
  explicit Loops(std::vector<OpenEdge> edges) : edges_(std::move(edges)) {
    std::sort(edges_.begin(), edges_.end(), [](const OpenEdge& a, const OpenEdge& b) {
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    std::size_t begin = 0;
    for (const OpenEdge& edge : edges_) {
      if (from_.empty() || from_.back() != edge.from) {
        from_.push_back(edge.from);
        first_.push_back(begin);
      }
      ++begin;
    }
    first_.push_back(edges_.size());
    for (OpenEdge& edge : edges_) edge.to = place_of(edge.to);
    on_path_.assign(from_.size(), kNone);
  }

  template <class Emit>
  void each(const Emit& emit, const StopPoll& stop) {
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    std::vector<std::uint32_t> path, loop;
    for (std::uint32_t start = 0; start < from_.size(); ++start) {
      path.assign(1, start);
      on_path_[start] = 0;
      while (true) {
        stop.now();
        const std::uint32_t at = path.back();
        std::size_t& edge = next[at];
        while (edge < first_[at + 1] && edges_[edge].times == 0) ++edge;
        if (edge == first_[at + 1]) break;  // back at the start, for good
        --edges_[edge].times;
        const std::uint32_t to = edges_[edge].to;
        if (on_path_[to] == kNone) {
          on_path_[to] = static_cast<std::uint32_t>(path.size());
          path.push_back(to);
          continue;
        }
        loop.clear();
        const std::size_t begin = on_path_[to];
        for (std::size_t i = begin; i < path.size(); ++i) loop.push_back(from_[path[i]]);
        emit(loop);
        for (std::size_t i = begin + 1; i < path.size(); ++i) on_path_[path[i]] = kNone;
        path.resize(begin + 1);
      }
      on_path_[start] = kNone;
    }
  }

 private:
  [[nodiscard]] std::uint32_t place_of(std::uint32_t vertex) const {
    return static_cast<std::uint32_t>(std::lower_bound(from_.begin(), from_.end(), vertex) -
                                      from_.begin());
  }

  std::vector<OpenEdge> edges_;      // by where they begin; `to` is a place in from_
  std::vector<std::uint32_t> from_;  // vertices, ascending
  std::vector<std::size_t> first_;   // of each one's edges
  std::vector<std::uint32_t> on_path_;
};

// Triangles that end at the loop: one over the whole, one over each half, and so on, so that most
// are small and lie at the edges.
template <class Take>
void fill_loop(const std::vector<std::uint32_t>& loop, std::size_t first, std::size_t last,
               const Take& take) {
  if (last - first < 2) return;
  const std::size_t middle = first + (last - first) / 2;
  take(loop[first], loop[middle], loop[last]);
  fill_loop(loop, first, middle, take);
  fill_loop(loop, middle, last, take);
}

template <class Real>
Mesh<Real> fill_mesh(MeshView<Real> surface, const WorkOptions& work, std::size_t& loops) {
  const StopPoll stop(work.stop);
  Mesh<Real> mesh;
  std::vector<std::uint32_t> used;
  const auto take = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const predicate::TriangleD triangle{predicate::to_double(surface.vertices[a]),
                                        predicate::to_double(surface.vertices[b]),
                                        predicate::to_double(surface.vertices[c])};
    if (!predicate::settle_has_area(triangle)) return;
    mesh.triangles.push_back({a, b, c});
    used.insert(used.end(), {a, b, c});
  };
  Loops(mesh::open_edges(surface, work))
      .each(
          [&](const std::vector<std::uint32_t>& loop) {
            ++loops;
            fill_loop(loop, 0, loop.size() - 1, take);
          },
          stop);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::uint32_t vertex : used) mesh.vertices.push_back(surface.vertices[vertex]);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) -
                                          used.begin());
    }
  }
  return mesh;
}

}  // namespace

template <class Real>
void make_fill(const Geometries<Real>& geometries, const WorkOptions& work, Fill<Real>& fill) {
  const auto meshes = geometries.meshes();
  std::size_t loops = 0;
  if (meshes.size() == 1) {
    fill.mesh = fill_mesh(meshes[0], work, loops);
  } else {
    const OneMesh<Real> together(geometries, all_of(meshes.size()), StopPoll(work.stop),
                                 "find where the surface ends", "");
    fill.mesh = fill_mesh(MeshView<Real>{together.vertices, together.triangles}, work, loops);
  }
  BuildOptions options{.quality = Quality::Fast, .work = work};
  const MeshView<Real> view = fill.mesh.view();
  fill.geometries = Geometries<Real>(std::span(&view, 1), options);
  fill.tree = bvh::build(fill.geometries, options);  // it cuts no triangle
  fill.winding = winding_tree(fill.tree, fill.geometries, work);
  // The more holes, the more clusters; too large a share means a second traversal.
  fill.winding.share = 1 / std::clamp(static_cast<double>(loops) + 4, 16.0, 64.0);
}

template void make_fill(const Geometries<float>&, const WorkOptions&, Fill<float>&);
template void make_fill(const Geometries<double>&, const WorkOptions&, Fill<double>&);

}  // namespace pierce::scene
