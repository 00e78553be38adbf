// SPDX-License-Identifier: Apache-2.0
//
// pierce weld: meshes into one whose vertices at equal, or nearly equal, positions are one vertex.
#include "io/weld.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "choice.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "io/write_mesh.h"
#include "one_mesh.h"
#include "output.h"
#include "pierce/closed.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

struct WeldArguments {
  MeshOptions meshes;
  std::string out;
  double distance = 0;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
  bool quiet = false, json = false;
};

template <class Real>
struct Welding {
  std::uint64_t vertices, triangles;  // that there were
  io::WeldedMesh<Real> mesh;
  Closedness before, after;
  double seconds;

  [[nodiscard]] MeshView<Real> view() const { return {mesh.vertices, mesh.triangles}; }
};

std::string change(std::uint64_t before, std::uint64_t after) {
  return fmt::format("{} of {}", grouped(after), grouped(before));
}

template <class Real>
void print_text(const WeldArguments& options, const Welding<Real>& welding) {
  Summary table;
  table.add("vertices", change(welding.vertices, welding.mesh.vertices.size()));
  table.add("triangles", change(welding.triangles, welding.mesh.triangles.size()));
  table.add("collapsed", fmt::format("{}, left out", grouped(welding.mesh.collapsed)));
  table.add("moved", fmt::format("at most {:.3g}", welding.mesh.farthest));
  table.add("open edges",
            fmt::format("{}, by position {} before", grouped(welding.after.unbalanced_edges),
                        grouped(welding.before.unbalanced_edges)));
  table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
  table.add("weld", timing(welding.seconds, welding.vertices, "vertices"));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
void print_json(const WeldArguments& options, const Welding<Real>& welding) {
  io::JsonWriter json;
  json.open_object();
  json.value("command", "weld");
  json.value("mesh", name_of(options.meshes.files));
  add_meshes(json, options.meshes.files);
  json.value("precision", std::is_same_v<Real, float> ? "float" : "double");
  json.value("distance", options.distance);
  json.value("vertices_before", welding.vertices);
  json.value("vertices", welding.mesh.vertices.size());
  json.value("triangles_before", welding.triangles);
  json.value("triangles", welding.mesh.triangles.size());
  json.value("collapsed", welding.mesh.collapsed);
  json.value("moved", welding.mesh.farthest);
  json.value("open_edges_before", welding.before.unbalanced_edges);
  json.value("open_edges", welding.after.unbalanced_edges);
  json.value("seconds", welding.seconds);
  json.value("out", options.out);
  finish_json(json);
}

template <class Real>
int weld_as(const WeldArguments& options, const std::vector<Geometry>& geometries) {
  std::vector<std::vector<Vec3<Real>>> rounded;
  std::vector<MeshView<Real>> views;
  for (const Geometry& geometry : geometries) {
    if constexpr (std::is_same_v<Real, float>) {
      rounded.push_back(
          naming_file(geometry.name(), [&] { return io::to_float(geometry.mesh.vertices); }));
      views.push_back({rounded.back(), geometry.mesh.triangles});
    } else {
      views.push_back(geometry.mesh.view());
    }
  }
  const OneMesh<Real> together(views);
  const WorkOptions work = {.threads = options.threads};
  Welding<Real> welding = {
      together.view().vertices.size(), together.view().triangles.size(), {}, {}, {}, 0};
  const Stopwatch watch;
  welding.mesh = io::weld(together.view(), options.distance);
  welding.seconds = watch.seconds();
  if (welding.mesh.triangles.empty()) {
    throw Error(ErrorCode::BadFile, name_of(options.meshes.files) +
                                        ": every triangle collapses; weld by a smaller distance");
  }
  io::write_mesh(options.out, welding.view());
  if (options.quiet && !options.json) return 0;
  welding.before = closedness(together.view(), SameVertex::Position, work);
  welding.after = closedness(welding.view(), SameVertex::Index, work);
  if (options.json) {
    print_json(options, welding);
  } else {
    print_text(options, welding);
  }
  return 0;
}

int run(const WeldArguments& options) {
  check_extension(options.out, {io::kMeshExtensions.begin(), io::kMeshExtensions.end()});
  refuse_to_replace(options.out, inputs(options.meshes));
  if (!(options.distance >= 0) || options.distance > 1e300) {
    throw UsageError("--distance: give a number from 0 to 1e300, in the units of the mesh");
  }
  for (const std::string& file : options.meshes.files) {
    if (is_scene_file(file)) {
      throw UsageError(file + " is a scene file, whose vertices stay as they are; give meshes");
    }
  }
  const std::vector<Geometry> geometries = read_geometries(options.meshes);
  return choose_float(options.precision, geometries) ? weld_as<float>(options, geometries)
                                                     : weld_as<double>(options, geometries);
}

}  // namespace

Command add_weld(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("weld", "Make vertices at one place, or nearly, one vertex");
  const auto options = std::make_shared<WeldArguments>();
  add_mesh_arguments(*sub, options->meshes);
  sub->add_option("--out", options->out, "The mesh: .ply, .obj, .stl or .npz")->required();
  sub->add_option("--distance", options->distance,
                  "How far a vertex may move, at most, in the units of the mesh; 0: only equal "
                  "positions become one, -0 and 0 being equal")
      ->type_name("D");
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  sub->add_flag("--quiet", options->quiet, "Print no summary");
  sub->add_flag("--json", options->json, "Print the summary to standard output, as JSON");
  sub->footer(
      "Examples:\n"
      "  pierce weld part.stl --out part.ply\n"
      "  pierce weld left.ply right.ply --distance 1e-4 --out both.ply\n"
      "In the order of the files each vertex becomes the first kept one at most D away, or else "
      "is\n"
      "kept itself. So no new coordinates arise, no vertex moves further than D, kept ones are\n"
      "further than D apart, and the result is the same on every machine. Triangles of which two\n"
      "corners become one vertex collapse: they are counted and left out; others keep their "
      "order.\n"
      "Several meshes become one. Normals, colours and texture coordinates are not kept. STL "
      "holds\n"
      "corners, not vertices, and only 32-bit numbers. .npz holds arrays vertices and triangles.\n"
      "`pierce info MESH --open-edges FILE` tells how wide the cracks of a mesh are.\n"
      "The members of --json: command mesh meshes precision distance vertices_before vertices\n"
      "triangles_before triangles collapsed moved open_edges_before open_edges seconds out.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
