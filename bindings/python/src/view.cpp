// SPDX-License-Identifier: Apache-2.0
//
// Scenes as pages for a browser.
#include "view.h"

#include <nanobind/stl/string.h>

#include <string>
#include <vector>

#include "buffer.h"
#include "io/view_page.h"
#include "run.h"
#include "scene.h"

namespace pierce::python {
namespace {

// meshes: as SceneOf has them, with a list of names; rays (n, 8), numbers (m, 4), names (m, 3)
// uint32: ray, geometry, triangle. Returns the page, UTF-8.
template <class Real>
nb::bytes view_page(const std::string& title, bool z_up, const nb::list& meshes,
                    const nb::list& mesh_names, nb::handle rays, nb::handle numbers,
                    nb::handle names) {
  io::ViewContent<Real> content;
  content.title = title;
  content.z_up = z_up;
  std::vector<Buffer> buffers;
  std::vector<Transform<Real>> places(nb::len(meshes));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const nb::tuple mesh = nb::cast<nb::tuple>(meshes[i]);
    Buffer vertices(mesh[0], "vertices"), corners(mesh[1], "triangles"), map(mesh[2], "transform");
    io::ViewMesh<Real> made{nb::cast<std::string>(mesh_names[i]),
                            {vertices.packed<const Vec3<Real>, const Real>(3),
                             corners.packed<const Triangle, const std::uint32_t>(3)}};
    if (map.given()) {
      const auto rows = map.packed<const std::array<Real, 4>, const Real>(4);
      if (rows.size() != 3) throw nb::value_error("transform has another shape than expected");
      std::copy(rows.begin(), rows.end(), places[i].rows.begin());
      made.place = &places[i];
    }
    content.meshes.push_back(made);
    buffers.push_back(std::move(vertices));
    buffers.push_back(std::move(corners));
  }
  const Buffer ray_buffer(rays, "rays"), number_buffer(numbers, "numbers"),
      name_buffer(names, "names");
  content.rays = ray_buffer.packed<const Ray<Real>, const Real>(8);
  const auto of_hits = number_buffer.packed<const std::array<Real, 4>, const Real>(4);
  const auto named = name_buffer.packed<const std::array<std::uint32_t, 3>, const std::uint32_t>(3);
  if (of_hits.size() != named.size()) throw nb::value_error("hits of different lengths");
  std::string page;
  run({}, Length::Long, [&](const WorkOptions&) {
    for (std::size_t i = 0; i < named.size(); ++i) content.hits.push_back({of_hits[i], named[i]});
    io::write_view_page<Real>(content, [&](std::string_view part) { page += part; });
  });
  return nb::bytes(page.data(), page.size());
}

}  // namespace

void add_view(nb::module_& module) {
  module.def("view_page_float", &view_page<float>);
  module.def("view_page_double", &view_page<double>);
}

}  // namespace pierce::python
