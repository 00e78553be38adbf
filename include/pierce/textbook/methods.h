// SPDX-License-Identifier: Apache-2.0
//
// The textbook methods as a list, for whoever compares or times them all.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "pierce/textbook/baldwin_weber.h"
#include "pierce/textbook/cramer.h"
#include "pierce/textbook/determinants.h"
#include "pierce/textbook/moller_trumbore.h"
#include "pierce/textbook/plane_then_barycentric.h"
#include "pierce/textbook/plane_then_edges.h"
#include "pierce/textbook/precomputed_normal.h"
#include "pierce/textbook/watertight.h"

namespace pierce::textbook {

/// One method under its name.
template <class Scalar>
struct Method {
  std::string_view name;
  std::optional<TextbookHit<Scalar>> (*test)(const Ray<Scalar>&, const Vec3<Scalar>&,
                                             const Vec3<Scalar>&, const Vec3<Scalar>&);
  bool front_only = false;  ///< the culling form: a hit from behind is a miss
  bool epsilon = false;  ///< has an epsilon that is not 0, so it is wrong even over exact numbers
};

/// Every method, the two forms of moller_trumbore with their default epsilon and with 0.
template <class Scalar>
constexpr std::array<Method<Scalar>, 11> methods() {
  using R = const Ray<Scalar>&;
  using V = const Vec3<Scalar>&;
  return {{
      {"cramer", &cramer<Scalar>},
      {"determinants", &determinants<Scalar>},
      {"plane_then_edges", &plane_then_edges<Scalar>},
      {"plane_then_barycentric", &plane_then_barycentric<Scalar>},
      {"moller_trumbore", [](R ray, V a, V b, V c) { return moller_trumbore(ray, a, b, c); }, false,
       true},
      {"moller_trumbore, epsilon 0",
       [](R ray, V a, V b, V c) { return moller_trumbore(ray, a, b, c, 0); }},
      {"moller_trumbore_culling",
       [](R ray, V a, V b, V c) { return moller_trumbore_culling(ray, a, b, c); }, true, true},
      {"moller_trumbore_culling, epsilon 0",
       [](R ray, V a, V b, V c) { return moller_trumbore_culling(ray, a, b, c, 0); }, true},
      {"precomputed_normal", &precomputed_normal<Scalar>},
      {"watertight", &watertight<Scalar>},
      {"baldwin_weber", &baldwin_weber<Scalar>},
  }};
}

}  // namespace pierce::textbook
