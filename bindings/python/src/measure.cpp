// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <vector>

#include "buffer.h"
#include "columns.h"
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

}  // namespace

void add_measures(nb::module_& module) {
  module.def("measure_float", &measure_mesh<float>);
  module.def("measure_double", &measure_mesh<double>);
  module.def("self_intersections_float", &intersect_mesh<float>);
  module.def("self_intersections_double", &intersect_mesh<double>);
}

}  // namespace pierce::python
