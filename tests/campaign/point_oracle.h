// SPDX-License-Identifier: Apache-2.0
//
// Where a point lies and what is nearest to it, by the definitions, in integers.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "campaign/hit_oracle.h"
#include "pierce/nearest.h"
#include "pierce/options.h"

namespace pierce::campaign {

/// By the crossings of one ray, in the direction given. On a closed surface all give the same.
inline Location located(const World& world, const Point& p, const Point& direction,
                        InsideRule rule) {
  const Question ray{p, direction, 0, kInfinity<double>};
  const Crossings passed = crossings_of(world, candidates(world, p, direction), ray);
  if (passed.origin_on_surface) return Location::OnSurface;
  const bool inside =
      rule == InsideRule::NonZero ? passed.signed_count != 0 : passed.count % 2 == 1;
  return inside ? Location::Inside : Location::Outside;
}

/// The nearest point of one triangle: p + offset, at the square root of `square`.
struct ExactNearest {
  Ratio square;
  std::array<Ratio, 3> point;
  std::array<Ratio, 3> weights;  // of a, b, c
  TriangleRef ref;
  Feature feature = Feature::Face;
};

/// The nearest place on one triangle, found by asking every corner, edge and the face for its own.
class NearestOnTriangle {
 public:
  NearestOnTriangle(const Point& p, const Corners& corners) {
    scale_.see(p).see(corners.a).see(corners.b).see(corners.c);
    p_ = scale_.integers(p);
    corners_ = {scale_.integers(corners.a) - p_, scale_.integers(corners.b) - p_,
                scale_.integers(corners.c) - p_};
    for (int i = 0; i < 3; ++i) try_vertex(i);
    for (int i = 0; i < 3; ++i) try_edge(i, (i + 1) % 3);
    try_face();
  }

  [[nodiscard]] Ratio square() const { return scale_.restore(best_, 2); }
  [[nodiscard]] ExactNearest answer(const TriangleRef& ref) const {
    ExactNearest nearest{square(), {}, weights_, ref, feature_};
    const std::array<const Int IntVec::*, 3> axes{&IntVec::x, &IntVec::y, &IntVec::z};
    for (int axis = 0; axis < 3; ++axis) {
      Ratio sum(p_.*axes[axis]);
      for (int i = 0; i < 3; ++i) sum += weights_[i] * Ratio(corners_[i].*axes[axis]);
      nearest.point[axis] = scale_.restore(sum, 1);
    }
    return nearest;
  }

 private:
  void offer(const Ratio& square, Feature feature, std::array<Ratio, 3> weights) {
    if (found_ && square >= best_) return;
    found_ = true;
    best_ = square;
    feature_ = feature;
    weights_ = std::move(weights);
  }
  void try_vertex(int i) {
    std::array<Ratio, 3> weights;
    weights[i] = 1;
    offer(Ratio(dot(corners_[i], corners_[i])), Feature(int(Feature::VertexA) + i), weights);
  }
  void try_edge(int i, int j) {
    const IntVec e = corners_[j] - corners_[i];
    const Int length = dot(e, e);
    const Int along = -dot(corners_[i], e);
    if (along <= 0 || along >= length) return;
    std::array<Ratio, 3> weights;
    weights[j] = ratio(along, length);
    weights[i] = 1 - weights[j];
    offer(Ratio(dot(corners_[i], corners_[i])) - ratio(along * along, length),
          Feature(int(Feature::EdgeAB) + i), weights);
  }
  void try_face() {
    const auto& [a, b, c] = corners_;
    const IntVec n = cross(b - a, c - a);
    const Int area = dot(n, n);
    const Int wa = dot(n, cross(b, c)), wb = dot(n, cross(c, a)), wc = dot(n, cross(a, b));
    if (area == 0 || wa <= 0 || wb <= 0 || wc <= 0) return;
    const Int height = dot(n, a);
    offer(ratio(height * height, area), Feature::Face,
          {ratio(wa, area), ratio(wb, area), ratio(wc, area)});
  }

  Scale scale_;
  IntVec p_;
  std::array<IntVec, 3> corners_;
  bool found_ = false;
  Ratio best_;
  std::array<Ratio, 3> weights_;
  Feature feature_ = Feature::Face;
};

/// The square of how far p is from the triangle's box, at least, and from its corners.
inline std::pair<Wide, Wide> rough_squares(const Point& p, const Corners& corners) {
  const auto& [a, b, c] = corners;
  const auto gap = [](double x, double q, double r, double s) {
    const Wide below = Wide(std::min({q, r, s})) - Wide(x);
    const Wide above = Wide(x) - Wide(std::max({q, r, s}));
    return std::max({below, above, Wide(0)});
  };
  const auto square = [](const WideVec& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const Wide x = gap(p.x, a.x, b.x, c.x), y = gap(p.y, a.y, b.y, c.y), z = gap(p.z, a.z, b.z, c.z);
  return {x * x + y * y + z * z,
          std::min({square(WideVec(a, p)), square(WideVec(b, p)), square(WideVec(c, p))})};
}

/// The nearest of all triangles; of equally near ones the first.
inline std::optional<ExactNearest> nearest_of(const World& world, const Point& p) {
  std::vector<Wide> boxes(world.size());
  Wide corner = std::numeric_limits<Wide>::infinity();
  for (std::size_t i = 0; i < world.size(); ++i) {
    const auto [box, nearest] = rough_squares(p, world[i].corners);
    boxes[i] = box;
    corner = std::min(corner, nearest);
  }
  corner *= 1 + 0x1p-50L;  // far more than the roundings of these sums of squares
  std::optional<Ratio> best;
  std::size_t which = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (boxes[i] > corner) continue;
    const Ratio square = NearestOnTriangle(p, world[i].corners).square();
    if (best && square >= *best) continue;
    best = square;
    which = i;
  }
  if (!best) return std::nullopt;
  return NearestOnTriangle(p, world[which].corners).answer(world[which].ref);
}

template <class Real>
NearestPoint<Real> rounded_nearest(const std::optional<ExactNearest>& nearest, Real radius) {
  if (!nearest) return {};
  if (!std::isinf(radius) && nearest->square > Ratio(double{radius}) * Ratio(double{radius})) {
    return {};
  }
  const auto& [a, b, c] = nearest->weights;
  const auto& [x, y, z] = nearest->point;
  return {{rounded<Real>(x), rounded<Real>(y), rounded<Real>(z)},
          rounded_root<Real>(nearest->square),
          rounded<Real>(b),
          rounded<Real>(c),
          rounded<Real>(a),
          nearest->ref.geometry,
          nearest->ref.triangle,
          nearest->feature};
}

}  // namespace pierce::campaign
