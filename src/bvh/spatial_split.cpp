// SPDX-License-Identifier: Apache-2.0
#include "bvh/spatial_split.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "bvh/binning.h"

namespace pierce::bvh {
namespace {

constexpr int kSpatialBins = 16;

bool is_empty(const Box& box) {
  return box.lower[0] > box.upper[0] || box.lower[1] > box.upper[1] || box.lower[2] > box.upper[2];
}

Box common(const Box& a, const Box& b) {
  return Box{max4(a.lower, b.lower), min4(a.upper, b.upper)};
}

/// The planes between the bins along one axis.
class Slabs {
 public:
  Slabs(const Box& all, int axis) : lower_(all.lower[axis]), extent_(all.upper[axis] - lower_) {}

  [[nodiscard]] bool useful() const { return extent_ > 1e-6F; }
  [[nodiscard]] float below(int bin) const {
    return lower_ + extent_ * (static_cast<float>(bin) * (1.0F / kSpatialBins));
  }
  [[nodiscard]] int bin_of(float x) const {
    if (!useful()) return 0;
    return std::clamp(static_cast<int>((x - lower_) / extent_ * kSpatialBins), 0, kSpatialBins - 1);
  }

 private:
  float lower_, extent_;
};

Float4 to_float(const Vec3<double>& p) {
  return Float4{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0.0F};
}

/// What lies in each slab: about, for the heuristic only, so without directed rounding.
class SpatialBins {
 public:
  SpatialBins(const Box& all, int axis) : slabs_(all, axis), axis_(axis) {}

  void add(const PrimitiveRef& ref, Float4 a, Float4 b, Float4 c) {
    const int first = slabs_.bin_of(ref.box.lower[axis_]);
    const int last = std::max(first, slabs_.bin_of(ref.box.upper[axis_]));
    ++enter_[first];
    ++leave_[last];
    if (first == last) {
      box_[first].grow(ref.box);
      return;
    }
    Box piece[kSpatialBins];
    add_edge(a, b, first, last, piece);
    add_edge(b, c, first, last, piece);
    add_edge(c, a, first, last, piece);
    for (int bin = first; bin <= last; ++bin) {
      const Box part = common(piece[bin], ref.box);
      if (!is_empty(part)) box_[bin].grow(part);
    }
  }

  /// The cheapest plane between two bins, if it beats `best`.
  void choose(float weight, SpatialSplit& best) const {
    if (!slabs_.useful()) return;
    float right_cost[kSpatialBins];
    std::uint32_t right_count[kSpatialBins];
    Box right;
    std::uint32_t leaving = 0;
    for (int b = kSpatialBins - 1; b > 0; --b) {
      right.grow(box_[b]);
      leaving += leave_[b];
      right_count[b] = leaving;
      right_cost[b] = is_empty(right) ? 0.0F : half_area(right) * blocks(leaving, weight);
    }
    Box left;
    std::uint32_t entered = 0;
    for (int b = 1; b < kSpatialBins; ++b) {
      left.grow(box_[b - 1]);
      entered += enter_[b - 1];
      if (entered == 0 || right_count[b] == 0 || is_empty(left)) continue;
      const float cost = half_area(left) * blocks(entered, weight) + right_cost[b];
      if (!best.found() || cost < best.cost) {
        best = {axis_, slabs_.below(b), cost, {entered, right_count[b]}};
      }
    }
  }

 private:
  /// The edge's lower end and every point where it meets a plane, to the slabs they bound.
  void add_edge(Float4 p, Float4 q, int first, int last, Box* piece) const {
    if (p[axis_] > q[axis_]) std::swap(p, q);
    const int begin = std::clamp(slabs_.bin_of(p[axis_]), first, last);
    const int end = std::clamp(slabs_.bin_of(q[axis_]), first, last);
    piece[begin].grow(p);
    piece[end].grow(q);
    if (begin == end) return;
    const Float4 slope = (q - p) / (q[axis_] - p[axis_]);
    for (int bin = begin; bin < end; ++bin) {
      const Float4 middle = p + slope * (slabs_.below(bin + 1) - p[axis_]);
      piece[bin].grow(middle);
      piece[bin + 1].grow(middle);
    }
  }

  Slabs slabs_;
  int axis_;
  Box box_[kSpatialBins];
  std::uint32_t enter_[kSpatialBins] = {}, leave_[kSpatialBins] = {};
};

/// Grows by points in double; the box around them is rounded outward.
struct Cover {
  double lower[3] = {2, 2, 2}, upper[3] = {-2, -2, -2};

  void add(const double* p) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], p[k]);
      upper[k] = std::max(upper[k], p[k]);
    }
  }
  [[nodiscard]] Box outward() const {
    Box box;
    if (lower[0] > upper[0]) return box;
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = round_down(lower[k] - kCutSlack);
      box.upper[k] = round_up(upper[k] + kCutSlack);
    }
    return box;
  }
};

/// The boxes of the parts of a ref below and above a plane; one may be empty.
std::pair<Box, Box> cut(const PrimitiveRef& ref, const Primitives& primitives, int axis,
                        float place) {
  const Corners t = primitives.corners(ref.primitive());
  const double points[3][3] = {{t.a.x, t.a.y, t.a.z}, {t.b.x, t.b.y, t.b.z}, {t.c.x, t.c.y, t.c.z}};
  const auto plane = static_cast<double>(place);
  Cover below, above;
  for (int i = 0; i < 3; ++i) {
    const double* p = points[i];
    const double* q = points[(i + 1) % 3];
    if (p[axis] <= plane) below.add(p);
    if (p[axis] >= plane) above.add(p);
    if ((p[axis] < plane && q[axis] > plane) || (p[axis] > plane && q[axis] < plane)) {
      const double along = (plane - p[axis]) / (q[axis] - p[axis]);
      double middle[3];
      for (int k = 0; k < 3; ++k) middle[k] = p[k] + along * (q[k] - p[k]);
      middle[axis] = plane;
      below.add(middle);
      above.add(middle);
    }
  }
  std::pair<Box, Box> parts = {common(below.outward(), ref.box), common(above.outward(), ref.box)};
  // The slack is for the other two axes.
  parts.first.upper[axis] = std::min<float>(parts.first.upper[axis], place);
  parts.second.lower[axis] = std::max<float>(parts.second.lower[axis], place);
  return parts;
}

}  // namespace

SpatialSplit find_spatial_split(const PrimitiveRef* refs, std::uint32_t count, float weight,
                                const Primitives& primitives) {
  Box all;
  for (std::uint32_t i = 0; i < count; ++i) all.grow(refs[i].box);
  SpatialBins bins[3] = {SpatialBins(all, 0), SpatialBins(all, 1), SpatialBins(all, 2)};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Corners t = primitives.corners(refs[i].primitive());
    const Float4 a = to_float(t.a), b = to_float(t.b), c = to_float(t.c);
    for (SpatialBins& along : bins) along.add(refs[i], a, b, c);
  }
  SpatialSplit best;
  for (const SpatialBins& along : bins) along.choose(weight, best);
  return best;
}

std::optional<Sides> partition(const PrimitiveRef* refs, std::uint32_t count,
                               const SpatialSplit& split, const Primitives& primitives,
                               PrimitiveRef* left, PrimitiveRef* right,
                               const BuildControl& control) {
  constexpr std::uint32_t kPollEvery = 1 << 16;
  PrimitiveRef* const begin = left;
  PrimitiveRef* const end = right;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % kPollEvery == 0) control.poll();
    if (right - left < 2) return std::nullopt;
    const PrimitiveRef& ref = refs[i];
    if (ref.box.upper[split.axis] <= split.place) {
      *left++ = ref;
    } else if (ref.box.lower[split.axis] >= split.place) {
      *--right = ref;
    } else {
      const auto [below, above] = cut(ref, primitives, split.axis, split.place);
      if (is_empty(above)) {
        *left++ = ref;
      } else if (is_empty(below)) {
        *--right = ref;
      } else {
        *left++ = PrimitiveRef(below, ref.primitive());
        *--right = PrimitiveRef(above, ref.primitive());
      }
    }
  }
  const Sides sides{static_cast<std::uint32_t>(left - begin),
                    static_cast<std::uint32_t>(end - right)};
  if (std::min(sides.left, sides.right) == 0) return std::nullopt;
  if (std::max(sides.left, sides.right) >= count) return std::nullopt;
  return sides;
}

}  // namespace pierce::bvh
