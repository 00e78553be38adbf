// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "buffer.h"
#include "columns.h"
#include "io/weld.h"
#include "pierce/closed.h"
#include "pierce/measure.h"
#include "run.h"

namespace pierce::python {
namespace {

// A mesh, kept while it is looked at.
template <class Real>
class OneMesh {
 public:
  OneMesh(nb::handle vertices, nb::handle triangles)
      : vertices_(vertices, "vertices"), triangles_(triangles, "triangles") {}

  [[nodiscard]] MeshView<Real> view() const {
    return {vertices_.packed<const Vec3<Real>, const Real>(3),
            triangles_.packed<const Triangle, const std::uint32_t>(3)};
  }

 private:
  Buffer vertices_, triangles_;
};

template <class Real>
nb::dict measure_mesh(nb::handle vertices, nb::handle triangles, int same, const Control& control) {
  const OneMesh<Real> mesh(vertices, triangles);
  const MeshView<Real> view = mesh.view();
  MeshMeasures found;
  run(control, Length::Long,
      [&](const WorkOptions& work) { found = measure(view, static_cast<SameVertex>(same), work); });
  nb::dict result;
  result["volume"] = found.volume;
  result["area"] = found.area;
  result["vertices"] = found.vertices;
  result["edges"] = found.edges;
  result["triangles"] = found.triangles;
  result["euler"] = found.euler;
  result["components"] = found.components;
  result["consistent"] = found.consistent;
  result["orientable"] = found.orientable;
  return result;
}

template <class Real>
nb::tuple intersect_mesh(nb::handle vertices, nb::handle triangles, const Control& control) {
  const OneMesh<Real> mesh(vertices, triangles);
  const MeshView<Real> view = mesh.view();
  std::vector<TrianglePair> pairs;
  run(control, Length::Long,
      [&](const WorkOptions& work) { pairs = self_intersections(view, work); });
  GrowingColumn<std::int64_t> first, second;
  first.reserve(pairs.size());
  second.reserve(pairs.size());
  std::int64_t* const firsts = first.rows(0, pairs.size()).data;
  std::int64_t* const seconds = second.rows(0, pairs.size()).data;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    firsts[i] = pairs[i].first;
    seconds[i] = pairs[i].second;
  }
  return nb::make_tuple(first.release(pairs.size()), second.release(pairs.size()));
}

nb::object edge_use(const std::optional<EdgeUse>& use) {
  if (!use) return nb::none();
  nb::dict result;
  result["triangle"] = use->triangle;
  result["edge"] = nb::make_tuple(use->from, use->to);
  result["other_triangle"] =
      use->other_triangle == kNone ? nb::none() : nb::object(nb::int_(use->other_triangle));
  result["forward"] = use->forward;
  result["backward"] = use->backward;
  return result;
}

template <class Real>
nb::dict close_mesh(nb::handle vertices, nb::handle triangles, int same, const Control& control) {
  const OneMesh<Real> mesh(vertices, triangles);
  const MeshView<Real> view = mesh.view();
  Closedness found;
  run(control, Length::Long, [&](const WorkOptions& work) {
    found = closedness(view, static_cast<SameVertex>(same), work);
  });
  nb::dict result;
  result["closed"] = found.closed;
  result["balanced"] = found.balanced;
  result["even"] = found.even;
  result["watertight"] = found.watertight;
  result["watertight_even"] = found.watertight_even;
  result["edges"] = found.edges;
  result["open_edges"] = found.open_edges;
  result["unbalanced_edges"] = found.unbalanced_edges;
  result["odd_edges"] = found.odd_edges;
  result["crowded_edges"] = found.crowded_edges;
  result["unbalanced_in_pieces"] = found.unbalanced_in_pieces;
  result["odd_in_pieces"] = found.odd_in_pieces;
  result["first_unbalanced"] = edge_use(found.first_unbalanced);
  result["first_odd"] = edge_use(found.first_odd);
  result["first_crowded"] = edge_use(found.first_crowded);
  return result;
}

// (vertices, triangles, vertex_of, collapsed, farthest)
template <class Real>
nb::tuple weld_mesh(nb::handle vertices, nb::handle triangles, double distance) {
  const OneMesh<Real> mesh(vertices, triangles);
  const MeshView<Real> view = mesh.view();
  io::WeldedMesh<Real> welded;
  run({}, Length::Long, [&](const WorkOptions& work) {
    welded = io::weld(view, distance, scene::StopPoll(work.stop));
  });
  const std::size_t count = welded.vertex_of.size();
  GrowingColumn<std::int64_t> vertex_of;
  vertex_of.reserve(count);
  std::copy_n(welded.vertex_of.data(), count, vertex_of.rows(0, count).data);
  return nb::make_tuple(table_of<Real>(std::move(welded.vertices)),
                        table_of<std::uint32_t>(std::move(welded.triangles)),
                        vertex_of.release(count), welded.collapsed, welded.farthest);
}

}  // namespace

void add_measures(nb::module_& module) {
  module.def("measure_float", &measure_mesh<float>);
  module.def("measure_double", &measure_mesh<double>);
  module.def("closedness_float", &close_mesh<float>);
  module.def("closedness_double", &close_mesh<double>);
  module.def("self_intersections_float", &intersect_mesh<float>);
  module.def("self_intersections_double", &intersect_mesh<double>);
  module.def("weld_float", &weld_mesh<float>);
  module.def("weld_double", &weld_mesh<double>);
}

}  // namespace pierce::python
