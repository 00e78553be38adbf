// SPDX-License-Identifier: Apache-2.0
//
// What `pierce info` says of how large a mesh is, of how many pieces, and which way it faces.
#pragma once

#include "io/json_writer.h"
#include "output.h"
#include "pierce/measure.h"

namespace pierce::tool {

void add_measures(Summary& table, const MeshMeasures& measures);
void add_measures(io::JsonWriter& json, const MeshMeasures& measures);

}  // namespace pierce::tool
