// SPDX-License-Identifier: Apache-2.0
//
// The meshes on the command line: files, each one geometry of the scene or as many as it has parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "failure.h"
#include "io/json_writer.h"
#include "io/mesh.h"
#include "stored_scene.h"

namespace CLI {
class App;
}

namespace pierce::tool {

struct MeshOptions {
  std::vector<std::string> files;
  bool parts = false;
  bool strict = false;  ///< what is only remarked upon otherwise is an error
  bool verify = false;  ///< of scene files, every byte
};

/// MESH..., required, --parts and --strict.
void add_mesh_arguments(CLI::App& app, MeshOptions& options);
/// --parts and --strict alone.
void add_reading_flags(CLI::App& app, MeshOptions& options);

/// What messages call all of them: "a.ply", "a.ply and b.obj", "a.ply and 2 others".
[[nodiscard]] std::string name_of(const std::vector<std::string>& files);

/// Each by its name: the array `meshes`.
void add_meshes(io::JsonWriter& json, const std::vector<std::string>& files);

/// The mesh files and others: all that is read.
[[nodiscard]] std::vector<std::filesystem::path> inputs(const MeshOptions& meshes,
                                                        const std::vector<std::string>& more = {});

/// One geometry of a scene.
struct Geometry {
  std::string file;
  std::string part;  ///< "part 'wheel'", or nothing if it is the whole file
  io::Mesh mesh;     ///< of a scene file's no vertices and triangles
  std::shared_ptr<const StoredScene> stored = {};  ///< the scene file, if it comes from one
  std::size_t number = 0;                          ///< and which of its geometries it is

  [[nodiscard]] std::string name() const { return part.empty() ? file : file + ", " + part; }
};

/// Reads the file and prints its warnings; a mesh without a single triangle is Error (BadFile).
[[nodiscard]] io::Mesh read_triangles(const std::string& path, bool strict);

/// Prints what there is to know of how a file was read, a line each, which begins with its name;
/// if it is to be `strict`, the first line is Error (BadFile).
void print_warnings(std::span<const std::string> lines, bool strict);

/// Reads all files, in order; none is without triangles.
[[nodiscard]] std::vector<Geometry> read_geometries(const MeshOptions& options);

/// What --precision says. Auto takes float where that loses nothing.
enum class Precision : std::uint8_t { Auto, Float, Double };

void add_precision_option(CLI::App& app, Precision& precision);

/// Whether to compute in float. Says so in a remark if that rounds numbers. `other` names what else
/// is read, if anything, and `other_single` whether its numbers are 32 bits long.
[[nodiscard]] bool choose_float(Precision precision, std::span<const Geometry> geometries,
                                const std::string& other = {}, bool other_single = true);

/// Runs `work`; errors about what the library was given come out with the names of the mesh files.
template <class Work>
auto naming_meshes(const MeshOptions& meshes, Work work) {
  return naming_file(name_of(meshes.files), std::move(work));
}

}  // namespace pierce::tool
