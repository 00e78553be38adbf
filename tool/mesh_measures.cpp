// SPDX-License-Identifier: Apache-2.0
#include "mesh_measures.h"

#include <fmt/format.h>

namespace pierce::tool {

void add_measures(Summary& table, const MeshMeasures& measures) {
  table.add("volume", fmt::format("{}", measures.volume));
  table.add("area", fmt::format("{}", measures.area));
  table.add("components", grouped(measures.components));
  table.add("Euler number", fmt::format("{}", measures.euler));
  table.add("facing", measures.consistent   ? "neighbours face the same way"
                      : measures.orientable ? "some neighbours face opposite ways; all could agree"
                                            : "some neighbours face opposite ways, and not all can "
                                              "agree (as on a Moebius strip)");
}

void add_measures(io::JsonWriter& json, const MeshMeasures& measures) {
  json.value("volume", measures.volume);
  json.value("area", measures.area);
  json.value("components", measures.components);
  json.value("euler", measures.euler);
  json.value("consistent", measures.consistent);
  json.value("orientable", measures.orientable);
}

}  // namespace pierce::tool
