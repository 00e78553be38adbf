// SPDX-License-Identifier: Apache-2.0
//
// The names of a list of kinds, for messages.
#pragma once

#include <string>

namespace pierce::bench {

/// "bunny, city, terrain"
template <class Kinds>
std::string names_of(const Kinds& kinds) {
  std::string names;
  for (const auto& kind : kinds) {
    if (!names.empty()) names.append(", ");
    names.append(kind.name);
  }
  return names;
}

}  // namespace pierce::bench
