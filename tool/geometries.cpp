// SPDX-License-Identifier: Apache-2.0
#include "geometries.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "choice.h"
#include "io/bad_file.h"
#include "io/read_mesh.h"
#include "io/split_parts.h"
#include "output.h"

namespace pierce::tool {
namespace {

std::string part_text(const std::string& name) {
  return name.empty() ? "part without a name" : "part " + io::in_quotes(name);
}

// Names of files whose coordinates are not all 32 bits long, each once.
std::vector<std::string> wide_files(std::span<const Geometry> geometries) {
  std::vector<std::string> names;
  for (const Geometry& g : geometries) {
    const bool known = !names.empty() && names.back() == g.file;
    if (!g.mesh.single_precision && !known) names.push_back(g.file);
  }
  return names;
}

}  // namespace

void add_mesh_arguments(CLI::App& app, MeshOptions& options) {
  app.add_option("MESH", options.files,
                 "Mesh files (PLY, STL, OBJ, OFF, glTF, 3MF, 3DS, ...) also packed "
                 "by gzip or zstd, or scene files (.pierce): geometry 0, 1, ...")
      ->required();
  add_reading_flags(app, options);
}

void add_reading_flags(CLI::App& app, MeshOptions& options) {
  app.add_flag(
      "--parts", options.parts,
      "Every part of a file is a geometry of its own: object or group of an OBJ, solid of "
      "an ascii STL, node of a glTF, placed object of a 3MF; `pierce info --parts` lists them");
  app.add_flag(
      "--strict", options.strict,
      "Refuse a file that is not as it should be, where otherwise a warning is printed and "
      "what cannot be read is passed over");
}

std::string name_of(const std::vector<std::string>& files) {
  if (files.size() == 2) return files[0] + " and " + files[1];
  if (files.size() > 2) return fmt::format("{} and {} others", files[0], files.size() - 1);
  return files.empty() ? "" : files[0];
}

void add_meshes(io::JsonWriter& json, const std::vector<std::string>& files) {
  json.open_array("meshes");
  for (const std::string& file : files) json.value("", file);
  json.close_array();
}

std::vector<std::filesystem::path> inputs(const MeshOptions& meshes,
                                          const std::vector<std::string>& more) {
  std::vector<std::filesystem::path> all(meshes.files.begin(), meshes.files.end());
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void print_warnings(std::span<const std::string> lines, bool strict) {
  if (lines.empty()) return;
  if (strict) {
    const std::string more =
        lines.size() > 1 ? fmt::format(" (the first of {} warnings)", lines.size()) : "";
    throw Error(ErrorCode::BadFile, lines[0] + more + "; --strict refuses it");
  }
  for (const std::string& line : lines) remark("pierce: " + line + "\n");
}

io::Mesh read_triangles(const std::string& path, bool strict) {
  io::Mesh mesh = io::read_mesh(path);
  std::vector<std::string> lines;
  for (const std::string& warning : mesh.warnings) lines.push_back(path + ": " + warning);
  print_warnings(lines, strict);
  if (!mesh.triangles.empty()) return mesh;
  throw Error(ErrorCode::BadFile,
              fmt::format("{}: holds no triangle ({}); give a mesh that has faces", path,
                          counted(mesh.vertices.size(), "vertex", "vertices")));
}

namespace {

// What a scene file holds stays there.
void add_stored(std::vector<Geometry>& all, const std::string& file, bool verify) {
  const auto stored = std::make_shared<const StoredScene>(file, verify);
  const auto& geometries = stored->info().geometries;
  if (stored->info().triangles == 0) {
    throw Error(ErrorCode::BadFile, file + ": holds no triangle; build it of meshes with faces");
  }
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    io::Mesh mesh;
    mesh.single_precision = stored->info().bits == 32;
    mesh.format = fmt::format("scene file, version {}", stored->info().version);
    const std::string& name = geometries[i].name;
    all.push_back({file, geometries.size() == 1 || name.empty() ? "" : io::in_quotes(name, 200),
                   std::move(mesh), stored, i});
  }
}

}  // namespace

std::vector<Geometry> read_geometries(const MeshOptions& options) {
  std::vector<Geometry> all;
  for (const std::string& file : options.files) {
    if (is_scene_file(file)) {
      add_stored(all, file, options.verify);
      continue;
    }
    io::Mesh mesh = read_triangles(file, options.strict);
    if (!options.parts) {
      all.push_back({file, {}, std::move(mesh), {}, 0});
      continue;
    }
    std::vector<io::NamedMesh> parts = io::split_parts(std::move(mesh));
    for (io::NamedMesh& part : parts) {
      const bool whole = parts.size() == 1 && part.name.empty();
      all.push_back({file, whole ? "" : part_text(part.name), std::move(part.mesh), {}, 0});
    }
  }
  return all;
}

void add_precision_option(CLI::App& app, Precision& precision) {
  add_choice<Precision>(
      app, "--precision", precision,
      {{"auto", Precision::Auto}, {"float", Precision::Float}, {"double", Precision::Double}},
      "Numbers to compute with and to write: float, double, or auto: float if all input is 32-bit "
      "by what its files declare (PLY with float properties, also as text; binary STL, glTF, 3DS, "
      "float32 arrays), else double");
}

bool choose_float(Precision precision, std::span<const Geometry> geometries,
                  const std::string& other, bool other_single) {
  std::vector<std::string> rounded = wide_files(geometries);
  if (!other_single) rounded.push_back(other);
  if (precision != Precision::Float) return precision == Precision::Auto && rounded.empty();
  if (!rounded.empty()) {
    remark(fmt::format("pierce: --precision float: the numbers of {} are rounded to 32 bits\n",
                       fmt::join(rounded, " and ")));
  }
  return true;
}

}  // namespace pierce::tool
