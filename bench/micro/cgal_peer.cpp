// SPDX-License-Identifier: Apache-2.0
//
// In a file of its own: CGAL wants flags of its own.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <utility>

#include "micro/peers.h"

namespace pierce::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct CgalCases::Impl {
  std::vector<std::pair<Kernel::Ray_3, Kernel::Triangle_3>> cases;
};

CgalCases::CgalCases(const std::vector<Case>& cases) : impl_(std::make_unique<Impl>()) {
  const auto point = [](const Double3& p) { return Kernel::Point_3(p.x, p.y, p.z); };
  for (const Case& c : cases) {
    const Double3& d = c.ray.direction;
    impl_->cases.emplace_back(
        Kernel::Ray_3(point(c.ray.origin), Kernel::Vector_3(d.x, d.y, d.z)),
        Kernel::Triangle_3(point(c.triangle.a), point(c.triangle.b), point(c.triangle.c)));
  }
}

CgalCases::~CgalCases() = default;

bool CgalCases::intersects(std::size_t i) const {
  const auto& [ray, triangle] = impl_->cases[i];
  return CGAL::do_intersect(ray, triangle);
}

}  // namespace pierce::bench
