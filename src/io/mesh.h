// SPDX-License-Identifier: Apache-2.0
//
// Mesh: what a mesh file holds, in memory that this program owns.
//
// Vertices are the file's vertices in the file's order, never merged, moved or reordered, and
// triangles are its triangles in order, polygons fanned from their first corner where that stays
// within them (io/polygons.h). Text numbers are
// the nearest doubles, or floats where the file declares floats; binary numbers are exact.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pierce/types.h"

namespace pierce::io {

/// Triangles in a row that belong to one part: from the first one to where the next run begins.
struct PartRun {
  std::uint32_t part = 0;  ///< index into the part names
  std::uint64_t first_triangle = 0;
};

/// The polygons of a file with four corners or more.
struct PolygonCounts {
  std::uint64_t all = 0;
  std::uint64_t refanned = 0;  ///< concave ones that a fan would reach out of
  std::uint64_t not_flat = 0;  ///< whose corners are not exactly in one plane
};

struct Mesh {
  std::vector<Vec3<double>> vertices;
  std::vector<Triangle> triangles;

  /// One per vertex, or empty if the file has none. A file that gives a vertex different normals
  /// or texture coordinates at different corners (OBJ) keeps the first one named.
  std::vector<Vec3<float>> normals;
  std::vector<Vec3<float>> colors;  ///< red, green, blue, 0 to 1
  std::vector<std::array<float, 2>> texcoords;

  /// Every coordinate is a 32-bit float by what the file declares (PLY with properties float,
  /// binary STL, glTF and 3DS unless a transform makes others of them), so a float scene over
  /// `to_float(vertices)` is over exactly the file's numbers.
  bool single_precision = false;

  /// The file's own division of its triangles: objects and groups of an OBJ, solids of an ascii
  /// STL, nodes of a glTF and of what comes through Assimp, placed objects of a 3MF; see
  /// io/split_parts.h. Without runs there is none.
  std::vector<std::string> part_names;
  std::vector<PartRun> part_runs;  ///< in order; the first begins at triangle 0

  PolygonCounts polygons;

  /// For people: "PLY, binary little endian".
  std::string format;

  /// What the user should know of how the file was read, a line each, without the file's name:
  /// what was passed over although it is not as it should be. No vertex or triangle is lost by it
  /// unless the line says so.
  std::vector<std::string> warnings;

  [[nodiscard]] MeshView<double> view() const { return {vertices, triangles}; }
};

/// Each coordinate rounded to the nearest float; exact if the mesh is single_precision. Throws
/// Error (InvalidArgument) naming the first vertex with a finite coordinate beyond the floats.
[[nodiscard]] std::vector<Vec3<float>> to_float(std::span<const Vec3<double>> vertices);

}  // namespace pierce::io
