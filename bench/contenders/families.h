// SPDX-License-Identifier: Apache-2.0
//
// The families of contenders, one file each. Each adds those of its contenders that are asked for.
#pragma once

#include <string>

#include "contenders/contender.h"

namespace pierce::bench {

/// Adds the contender of that name (and its engine, unless it is there already); false: no such.
bool add_pierce(Field& field, const std::string& name);
bool add_textbook(Field& field, const std::string& name);
#ifdef PIERCE_BENCH_EMBREE
bool add_embree(Field& field, const std::string& name);
std::string embree_version();
bool has_embree4();
bool add_embree4(Field& field, const std::string& name);
/// "none" if it is not there.
std::string embree4_version();
#endif
#ifdef PIERCE_BENCH_CGAL
bool add_cgal(Field& field, const std::string& name);
std::string cgal_version();
#endif

/// The engine of that type and name in the field, made if it is not there yet.
template <class Type, class... Arguments>
Type& shared_engine(Field& field, const std::string& name, const Arguments&... arguments) {
  for (const auto& engine : field.engines)
    if (engine->name() == name) return static_cast<Type&>(*engine);
  field.engines.push_back(std::make_unique<Type>(name, arguments...));
  return static_cast<Type&>(*field.engines.back());
}

}  // namespace pierce::bench
