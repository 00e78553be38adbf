// SPDX-License-Identifier: Apache-2.0
//
// One model part of a 3MF: its objects and its build.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/placement.h"

namespace pierce::io {

enum class ThreemfUnit { Micron, Millimetre, Centimetre, Inch, Foot, Metre };

[[nodiscard]] const char* unit_name(ThreemfUnit unit);
[[nodiscard]] double millimetres(ThreemfUnit unit);

/// An object in its place, in a build or in another object.
struct ThreemfComponent {
  std::string object;
  std::string path;  ///< the part that holds the object; empty: this one
  Matrix matrix;
};

struct ThreemfObject {
  std::string name;
  bool is_aid = false;  ///< a support, or what a program has uses of its own for
  std::vector<Vec3<double>> vertices;
  std::vector<Triangle> triangles;
  std::vector<ThreemfComponent> components;
};

struct ThreemfModel {
  ThreemfUnit unit = ThreemfUnit::Millimetre;
  std::map<std::string, ThreemfObject> objects;  ///< by id
  std::vector<ThreemfComponent> items;
};

/// Throws Error (BadFile) with the line; `name` is that of the file and the part.
[[nodiscard]] ThreemfModel parse_threemf_model(std::string_view text, const std::string& name);

}  // namespace pierce::io
