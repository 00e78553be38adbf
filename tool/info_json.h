// SPDX-License-Identifier: Apache-2.0
//
// pierce info --json: the same facts as its table, as members of one object.
#pragma once

#include <cstdint>

#include "io/json_writer.h"
#include "pierce/closed.h"
#include "pierce/scene.h"

namespace pierce::tool {

/// How a mesh closes, under `key`: an object.
void add_closedness(io::JsonWriter& json, const char* key, const Closedness& closedness);

/// The least and the largest coordinates, as `bounds`: an array of two points.
void add_bounds(io::JsonWriter& json, const Vec3<double>& low, const Vec3<double>& high);

/// The search tree.
void add_tree(io::JsonWriter& json, const SceneInfo& info, double build_seconds);

}  // namespace pierce::tool
