// SPDX-License-Identifier: Apache-2.0
//
// Which triangles have a point in common with a segment or a box.
#include <algorithm>
#include <cmath>
#include <vector>

#include "predicate/touch.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "space/local_space.h"
#include "support/finite.h"
#include "support/float_environment.h"

namespace pierce {
namespace {

// A segment in filter space, with room for what was rounded on its way there.
class SpaceSegment {
 public:
  SpaceSegment(const Vec3<double>& from, const Vec3<double>& to) {
    const double p[3] = {from.x, from.y, from.z}, q[3] = {to.x, to.y, to.z};
    double size = 1;
    for (int axis = 0; axis < 3; ++axis) {
      middle_[axis] = p[axis] / 2 + q[axis] / 2;
      half_[axis] = q[axis] / 2 - p[axis] / 2;
      size = std::max({size, std::fabs(p[axis]), std::fabs(q[axis])});
    }
    usable_ = size < 0x1p400;
    pad_ = 0x1p-40 * size;
    pad_square_ = 0x1p-36 * size * size;
  }

  [[nodiscard]] bool may_meet(const space::MiddleBox& box) const {
    if (!usable_) return true;
    const double away[3] = {middle_[0] - box.middle.x, middle_[1] - box.middle.y,
                            middle_[2] - box.middle.z};
    const double extent[3] = {box.half.x, box.half.y, box.half.z};
    for (int axis = 0; axis < 3; ++axis) {
      if (std::fabs(away[axis]) > extent[axis] + std::fabs(half_[axis]) + pad_) return false;
    }
    for (int axis = 0; axis < 3; ++axis) {  // square to the segment and to an axis
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      const double off = std::fabs(away[i] * half_[j] - away[j] * half_[i]);
      if (off > extent[i] * std::fabs(half_[j]) + extent[j] * std::fabs(half_[i]) + pad_square_) {
        return false;
      }
    }
    return true;
  }

 private:
  double middle_[3], half_[3];
  double pad_, pad_square_;
  bool usable_;
};

void sort_once(std::vector<std::uint32_t>& primitives) {
  std::sort(primitives.begin(), primitives.end());
  primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
}

// Keeps those for which `touches` is true.
template <class Real, class Touches>
void answer(const scene::Geometries<Real>& geometries, std::vector<std::uint32_t>& primitives,
            std::vector<TriangleRef>& out, const Touches& touches) {
  sort_once(primitives);
  out.clear();
  for (const std::uint32_t primitive : primitives) {
    if (touches(geometries.triangle(primitive))) out.push_back(geometries.ref(primitive));
  }
}

}  // namespace

template <class Real>
void Scene<Real>::touching_segment(const Vec3<Real>& from, const Vec3<Real>& to,
                                   std::vector<TriangleRef>& out) const {
  const FloatEnvironment environment;
  scene::validate_point(from);
  scene::validate_point(to);
  const Vec3<double> p = predicate::to_double(from), q = predicate::to_double(to);
  const SpaceSegment segment(impl_->geometries.space().map(p), impl_->geometries.space().map(q));
  std::vector<std::uint32_t> primitives;
  impl_->traverse_where([&](const space::MiddleBox& box) { return segment.may_meet(box); },
                        [&](std::uint32_t primitive) { primitives.push_back(primitive); });
  predicate::LadderCounts counts;
  answer(impl_->geometries, primitives, out, [&](const predicate::TriangleD& triangle) {
    return predicate::decide_segment_touches(p, q, triangle, counts);
  });
}

template <class Real>
void Scene<Real>::touching_box(const Vec3<Real>& lower, const Vec3<Real>& upper,
                               std::vector<TriangleRef>& out) const {
  const FloatEnvironment environment;
  scene::validate_point(lower);
  scene::validate_point(upper);
  out.clear();
  if (lower.x > upper.x || lower.y > upper.y || lower.z > upper.z) return;
  const Vec3<double> p = predicate::to_double(lower), q = predicate::to_double(upper);
  const space::FilterSpace& space = impl_->geometries.space();
  std::vector<std::uint32_t> primitives;
  impl_->traverse_box(space.map(p), space.map(q), [&](std::uint32_t primitive) {
    primitives.push_back(primitive);
    return false;
  });
  predicate::LadderCounts counts;
  answer(impl_->geometries, primitives, out, [&](const predicate::TriangleD& triangle) {
    return predicate::decide_box_touches(p, q, triangle, counts);
  });
}

template void Scene<float>::touching_segment(const Vec3<float>&, const Vec3<float>&,
                                             std::vector<TriangleRef>&) const;
template void Scene<double>::touching_segment(const Vec3<double>&, const Vec3<double>&,
                                              std::vector<TriangleRef>&) const;
template void Scene<float>::touching_box(const Vec3<float>&, const Vec3<float>&,
                                         std::vector<TriangleRef>&) const;
template void Scene<double>::touching_box(const Vec3<double>&, const Vec3<double>&,
                                          std::vector<TriangleRef>&) const;

}  // namespace pierce
