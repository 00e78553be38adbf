// SPDX-License-Identifier: Apache-2.0
//
// Unkind scenes: what users have and engines dislike, each beside a kind twin that asks the same of
// a scene without the unkindness. What a search tree is worth shows in the distance between them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pierce/options.h"
#include "pierce/types.h"
#include "pierce/voxelise.h"
#include "workloads/vector.h"

namespace pierce::bench {

enum class Ask : std::uint8_t {
  Closest,
  AllHits,  ///< timed by the hit, not by the ray
  Count,
  NextOrigin,  ///< of rays that hit
  Locate,
  SignedDistance,
  Nearest,
  Voxelise,  ///< timed by the cell; there is no single
};
[[nodiscard]] const char* name_of(Ask ask);

/// Vertices and triangles, in double, which holds floats as they are.
struct Shape {
  std::vector<Double3> vertices;
  std::vector<Triangle> triangles;
};

/// What is asked of what.
struct Subject {
  Shape shape;
  std::vector<Double3> moved;     ///< if any: where the vertices are moved to by a refit
  std::vector<Ray<double>> rays;  ///< t from 0 to infinity
  std::vector<Double3> points;    ///< of the questions about points
  Grid<double> grid{};            ///< of Voxelise
  bool in_double = false;         ///< else all numbers are rounded to float
  bool open_mesh = false;         ///< of the questions about the inside
  Sides sides = Sides::Both;      ///< that Closest sees
  std::size_t hidden = 0;         ///< the last so many triangles: masks hide them
  Quality quality = Quality::Balanced;
  std::size_t together = 0;  ///< questions in a batch; 0: all
  Double3 centre{0, 0, 0};   ///< what users of Embree would move to the origin
};

/// How many rays most scenes are asked, in full detail.
inline constexpr unsigned kRays = 2000;

/// How large to make a scene.
struct Detail {
  unsigned percent = 100;  ///< of lengths and counts; 1 to 100

  [[nodiscard]] unsigned count(unsigned full) const { return std::max(4U, full * percent / 100); }
  /// Of a sphere whose triangles are divided into four so often.
  [[nodiscard]] int levels(int full) const {
    return percent >= 50 ? full : percent >= 10 ? full - 2 : 2;
  }
};

struct UnkindScene {
  std::string name, description, twin;
  Ask ask;
  std::function<Subject(const Detail&)> unkind, kind;
};

/// All of them, in the order of the table.
[[nodiscard]] const std::vector<UnkindScene>& unkind_scenes();

// The parts of the list, a file each.
void add_outliers(std::vector<UnkindScene>& scenes);
void add_dense(std::vector<UnkindScene>& scenes);
void add_far_rays(std::vector<UnkindScene>& scenes);
void add_numbers(std::vector<UnkindScene>& scenes);
void add_points(std::vector<UnkindScene>& scenes);
void add_seen(std::vector<UnkindScene>& scenes);
void add_features(std::vector<UnkindScene>& scenes);
void add_vertices(std::vector<UnkindScene>& scenes);
void add_walls(std::vector<UnkindScene>& scenes);

}  // namespace pierce::bench
