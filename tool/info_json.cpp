// SPDX-License-Identifier: Apache-2.0
#include "info_json.h"

#include <vector>

namespace pierce::tool {

void add_closedness(io::JsonWriter& json, const char* key, const Closedness& c) {
  json.open_object(key);
  json.value("closed", c.closed);
  json.value("balanced", c.balanced);
  json.value("watertight", c.watertight);
  json.value("edges", c.edges);
  json.value("open_edges", c.open_edges);
  json.value("unbalanced_edges", c.unbalanced_edges);
  json.value("crowded_edges", c.crowded_edges);
  json.value("in_pieces", c.unbalanced_in_pieces);
  json.close_object();
}

void add_bounds(io::JsonWriter& json, const Vec3<double>& low, const Vec3<double>& high) {
  json.open_array("bounds");
  json.values("", std::vector{low.x, low.y, low.z});
  json.values("", std::vector{high.x, high.y, high.z});
  json.close_array();
}

void add_tree(io::JsonWriter& json, const SceneInfo& info, double build_seconds) {
  json.value("without_area", info.degenerate);
  json.value("build_seconds", build_seconds);
  json.value("nodes", info.nodes);
  json.value("leaves", info.leaves);
  json.value("sah_cost", info.sah_cost);
  json.value("tree_bytes", info.bytes);
}

}  // namespace pierce::tool
