// SPDX-License-Identifier: Apache-2.0
//
// pierce._core: what of the library the Python package calls.
#include <nanobind/nanobind.h>

#include <filesystem>
#include <memory>
#include <string>

#include "columns.h"
#include "io/read_mesh.h"
#include "kernels/kernel.h"
#include "measure.h"
#include "scene.h"
#include "scene/file/layout.h"
#include "support/private_mapping.h"
#include "textbook.h"
#include "view.h"

namespace pierce::python {
namespace {

// An Error becomes the exception of the same name in pierce._errors.
void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const nb::object type = nb::module_::import_("pierce._errors").attr(name_of(error.code()));
    const nb::object exception = type(error.what());
    const auto index = error.index();
    exception.attr("index") = index == Error::kNoIndex ? nb::none() : nb::object(nb::int_(index));
    exception.attr("count") = error.count();
    PyErr_SetObject(type.ptr(), exception.ptr());
  }
}

// A mesh file as (vertices (n, 3), triangles (m, 3), warnings); the vertices are float32 if the
// file's are. The path comes as the bytes that the file system knows.
nb::tuple read_mesh_file(const nb::bytes& path) {
  const std::filesystem::path file(std::string(path.c_str(), path.size()));
  io::Mesh mesh;
  std::vector<Vec3<float>> singles;
  run({}, Length::Long, [&](const WorkOptions&) {
    mesh = io::read_mesh(file);
    if (mesh.single_precision) singles = io::to_float(mesh.vertices);
  });
  nb::list warnings;
  for (const std::string& line : mesh.warnings) {
    // What a file calls its parts need not be UTF-8.
    warnings.append(nb::steal(PyUnicode_DecodeUTF8(
        line.data(), static_cast<Py_ssize_t>(line.size()), "backslashreplace")));
  }
  return nb::make_tuple(mesh.single_precision ? table_of<float>(std::move(singles))
                                              : table_of<double>(std::move(mesh.vertices)),
                        table_of<std::uint32_t>(std::move(mesh.triangles)), warnings);
}

// What a scene file holds, and where: (bits, quality, fingerprint, None or masks, geometries), each
// of these a tuple of its name, offset and count of its vertices, and of its triangles.
nb::tuple scene_file(const nb::bytes& path) {
  const std::string file(path.c_str(), path.size());
  const SceneFileInfo info = scene_file_info(file);
  const PrivateMapping map(file);
  const scene::SceneFileTable table(map.bytes(), file);
  nb::list geometries, masks;
  for (std::size_t i = 0; i < info.geometries.size(); ++i) {
    const auto& geometry = info.geometries[i];
    geometries.append(nb::make_tuple(nb::str(geometry.name.c_str()),
                                     table.geometries[i].vertices.offset, geometry.vertices,
                                     table.geometries[i].triangles.offset, geometry.triangles));
    masks.append(geometry.mask);
  }
  const nb::object known = table.header.has_masks != 0 ? nb::object(masks) : nb::none();
  return nb::make_tuple(info.bits, static_cast<int>(info.quality), info.fingerprint, known,
                        geometries);
}

template <class Real>
void bind_scene(nb::module_& module, const char* name) {
  using S = SceneOf<Real>;
  using Hold = typename S::Hold;
  nb::class_<S> scene(module, name);
  nb::class_<Hold>(scene, "Hold")
      .def_prop_ro("version", &Hold::version)
      .def("__enter__",
           [](nb::object hold) {
             nb::cast<Hold&>(hold).begin();
             return hold;
           })
      .def("__exit__", [](Hold& hold, const nb::args&) { hold.end(); });
  scene
      .def(nb::init<const nb::list&, int, nb::handle, std::uint64_t, const Control&>(),
           nb::arg("meshes"), nb::arg("quality"), nb::arg("masks").none(), nb::arg("flatten_limit"),
           nb::arg("control"))
      .def(nb::init<const nb::bytes&, bool, const Control&>())
      .def_prop_rw("known", &S::known, &S::set_known, nb::for_setter(nb::arg("value").none()))
      .def_prop_ro("version", &S::version)
      .def(
          "hold", [](S& held) { return Hold(held); }, nb::keep_alive<0, 1>())
      .def("refit", &S::refit)
      .def("save", &S::save)
      .def("closest_hits", &S::closest_hits)
      .def("closest_packed", &S::closest_packed)
      .def("any_hits", &S::any_hits)
      .def("count_hits", &S::count_hits)
      .def("crossings", &S::crossings)
      .def("all_hits", &S::all_hits)
      .def("hit_points", &S::hit_points)
      .def("next_origins", &S::next_origins)
      .def("normals", &S::normals)
      .def("locate", &S::locate)
      .def("signed_distances", &S::signed_distances)
      .def("winding_numbers", &S::winding_numbers)
      .def("nearest_points", &S::nearest_points, nb::arg("points"), nb::arg("radii").none(),
           nb::arg("columns"), nb::arg("control"))
      .def("nearest_packed", &S::nearest_packed, nb::arg("points"), nb::arg("radii").none(),
           nb::arg("control"))
      .def("nearest_triangles", &S::nearest_triangles)
      .def("touching_segments", &S::touching_segments)
      .def("touching_boxes", &S::touching_boxes)
      .def("voxelise", &S::voxelise)
      .def("info", &S::info)
      .def("forget_threads", &S::forget_threads);
}

}  // namespace

NB_MODULE(_core, module) {
  nb::register_exception_translator(translate);
  module.attr("__version__") = PIERCE_VERSION;
  module.def("read_mesh", &read_mesh_file);
  module.def("scene_file", &scene_file);
  module.def("room", &room);
  module.def("kernel", [] { return nb::str(kernels::active_kernel().name); });

  nb::class_<Control>(module, "Control")
      .def(
          "__init__",
          [](Control* self, unsigned threads, nb::object progress) {
            new (self) Control{threads, std::move(progress)};
          },
          nb::arg("threads"), nb::arg("progress").none());
  nb::class_<Question>(module, "Question")
      .def(nb::init<>())
      .def_rw("open_start", &Question::open_start)
      .def_rw("sides", &Question::sides)
      .def_rw("distinct", &Question::distinct)
      .def_rw("invalid_miss", &Question::invalid_miss)
      .def_rw("max_hits", &Question::max_hits)
      .def_rw("version", &Question::version)
      .def_rw("mask", &Question::mask)
      .def_rw("masks", &Question::masks, nb::for_setter(nb::arg("value").none()))
      .def_rw("skip", &Question::skip, nb::for_setter(nb::arg("value").none()))
      .def_rw("after", &Question::after, nb::for_setter(nb::arg("value").none()))
      .def_rw("control", &Question::control);
  nb::class_<PointQuestion>(module, "PointQuestion")
      .def(nb::init<>())
      .def_rw("rule", &PointQuestion::rule)
      .def_rw("open_mesh", &PointQuestion::open_mesh)
      .def_rw("control", &PointQuestion::control);
  bind_scene<float>(module, "SceneF");
  bind_scene<double>(module, "SceneD");
  add_textbook(module);
  add_view(module);
  add_measures(module);
}

}  // namespace pierce::python
