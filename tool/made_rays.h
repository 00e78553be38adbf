// SPDX-License-Identifier: Apache-2.0
//
// Rays made on the fly, by their number: ray i is the same on every machine, whatever was made
// before it, so that a billion of them need be stored nowhere.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/json_view.h"
#include "io/json_writer.h"
#include "pierce/types.h"
#include "render/camera.h"

namespace pierce::tool {

enum class RayKind : std::uint8_t {
  Camera,  ///< one a pixel, through its centre, row by row from the top left
  Grid,    ///< parallel, one a cell, row by row from the top left
  Lidar,   ///< a turning scanner: one a column of directions, ring by ring from the highest
  Sphere,  ///< random chords of a sphere: from a random point of it to another
};

/// All numbers that rays are made of. Only additions, multiplications, divisions and square roots
/// make rays of them, which round alike everywhere.
struct MadeRays {
  RayKind kind = RayKind::Camera;
  std::uint64_t width = 0, height = 1;  ///< of a sphere: all rays in one row
  std::uint64_t seed = 0;               ///< of a sphere
  /// Camera: as in Camera. Grid: the centre of the plane that rays start from; their direction;
  /// from the centre to the edges. Lidar: where it stands; the axis it turns about, the directions
  /// of columns 0 and width / 4, all of unit length. Sphere: its centre, and (radius, 0, 0).
  Vec3<double> origin = {}, forward = {}, right = {}, up = {};
  double lowest = 0, highest = 0;  ///< of a lidar's rings: tangents of their elevations

  [[nodiscard]] std::uint64_t count() const { return width * height; }
  /// Rays first, first + 1, ...
  template <class Real>
  void make(std::uint64_t first, std::span<Ray<Real>> out) const;
  /// As an object of the key `rays`, and back to the last bit. Throws Error (BadFile) if something
  /// is missing.
  void write(io::JsonWriter& json) const;
  static MadeRays read(const io::JsonView& json);

 private:
  template <class Real>
  void make_in_row(std::uint64_t row, std::uint64_t column, std::span<Ray<Real>> out) const;
  template <class Real>
  [[nodiscard]] Ray<Real> chord(std::uint64_t i) const;
};

[[nodiscard]] const char* name_of(RayKind kind);

extern template void MadeRays::make(std::uint64_t, std::span<Ray<float>>) const;
extern template void MadeRays::make(std::uint64_t, std::span<Ray<double>>) const;

}  // namespace pierce::tool
