// SPDX-License-Identifier: Apache-2.0
//
// A tree over the edges, halved at the middle of their longest extent.
#include "edge_widths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "pierce/vector.h"

namespace pierce::tool {
namespace {

using Point = std::array<double, 3>;

struct EdgeSegment {
  Point a, b;
  [[nodiscard]] Point middle() const {
    return {a[0] / 2 + b[0] / 2, a[1] / 2 + b[1] / 2, a[2] / 2 + b[2] / 2};
  }
};

struct SegmentNode {
  Point low, high;
  std::uint32_t first, last;  // of the order
  std::uint32_t child = 0;    // of two; 0: none
};

double square(double x) { return x * x; }

class SegmentTree {
 public:
  explicit SegmentTree(std::vector<EdgeSegment> segments)
      : segments_(std::move(segments)), order_(segments_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.push_back(node_of(0, static_cast<std::uint32_t>(order_.size())));
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) split(i);
  }

  [[nodiscard]] double width(std::uint32_t edge) const {
    const Point p = segments_[edge].middle();
    double best = std::numeric_limits<double>::infinity();  // squared
    std::vector<std::uint32_t>& stack = stack_;
    stack.assign(1, 0);
    while (!stack.empty()) {
      const SegmentNode& node = nodes_[stack.back()];
      stack.pop_back();
      if (box_distance(node, p) >= best) continue;
      if (node.child == 0) {
        for (std::uint32_t i = node.first; i < node.last; ++i) {
          best = std::min(best, distance(p, edge, order_[i]));
        }
        continue;
      }
      const bool left =
          box_distance(nodes_[node.child], p) < box_distance(nodes_[node.child + 1], p);
      stack.push_back(node.child + (left ? 1 : 0));
      stack.push_back(node.child + (left ? 0 : 1));
    }
    return std::sqrt(best);
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;

  [[nodiscard]] SegmentNode node_of(std::uint32_t first, std::uint32_t last) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    SegmentNode node = {
        {kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, first, last};
    for (std::uint32_t i = first; i < last; ++i) {
      const EdgeSegment& s = segments_[order_[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        node.low[k] = std::min({node.low[k], s.a[k], s.b[k]});
        node.high[k] = std::max({node.high[k], s.a[k], s.b[k]});
      }
    }
    return node;
  }

  void split(std::uint32_t index) {
    const SegmentNode node = nodes_[index];
    if (node.last - node.first <= kLeaf) return;
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (node.high[k] - node.low[k] > node.high[axis] - node.low[axis]) axis = k;
    }
    const std::uint32_t half = node.first + (node.last - node.first) / 2;
    std::nth_element(order_.begin() + node.first, order_.begin() + half, order_.begin() + node.last,
                     [&](std::uint32_t i, std::uint32_t j) {
                       return segments_[i].middle()[axis] < segments_[j].middle()[axis];
                     });
    nodes_[index].child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node_of(node.first, half));
    nodes_.push_back(node_of(half, node.last));
  }

  static double box_distance(const SegmentNode& node, const Point& p) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += square(std::max({node.low[k] - p[k], p[k] - node.high[k], 0.0}));
    }
    return sum;
  }

  // Squared; infinity if the nearest point is where the edges meet.
  [[nodiscard]] double distance(const Point& p, std::uint32_t edge, std::uint32_t other) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (edge == other) return kNone;
    const EdgeSegment& e = segments_[edge];
    const EdgeSegment& s = segments_[other];
    double along = 0, length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      along += (p[k] - s.a[k]) * (s.b[k] - s.a[k]);
      length += square(s.b[k] - s.a[k]);
    }
    constexpr double kEnd = 1e-9;  // in parts of the edge
    const double at = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    const auto meets = [&](const Point& end) { return end == e.a || end == e.b; };
    if (at < kEnd && meets(s.a)) return kNone;
    if (at > 1 - kEnd && meets(s.b)) return kNone;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += square(p[k] - (s.a[k] + at * (s.b[k] - s.a[k])));
    }
    return sum;
  }

  std::vector<EdgeSegment> segments_;
  std::vector<std::uint32_t> order_;
  std::vector<SegmentNode> nodes_;
  mutable std::vector<std::uint32_t> stack_;
};

}  // namespace

template <class Real>
std::vector<double> edge_widths(MeshView<Real> mesh, std::span<const EdgeUse> edges) {
  std::vector<EdgeSegment> segments;
  segments.reserve(edges.size());
  const auto point = [&](std::uint32_t vertex) -> Point {
    const Vec3<double> p = convert<double>(mesh.vertices[vertex]);
    return {p.x, p.y, p.z};
  };
  for (const EdgeUse& edge : edges) segments.push_back({point(edge.from), point(edge.to)});
  const SegmentTree tree(std::move(segments));
  std::vector<double> widths(edges.size());
  for (std::uint32_t i = 0; i < widths.size(); ++i) widths[i] = tree.width(i);
  return widths;
}

template std::vector<double> edge_widths(MeshView<float>, std::span<const EdgeUse>);
template std::vector<double> edge_widths(MeshView<double>, std::span<const EdgeUse>);

WidthSummary summary_of(std::span<const double> widths) {
  WidthSummary summary;
  std::vector<double> finite;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (!std::isfinite(widths[i])) continue;
    if (finite.empty() || widths[i] > summary.widest) {
      summary.widest = widths[i];
      summary.widest_edge = i;
    }
    finite.push_back(widths[i]);
    summary.zero += widths[i] == 0 ? 1 : 0;
  }
  summary.finite = finite.size();
  if (finite.empty()) return summary;
  std::sort(finite.begin(), finite.end());
  summary.narrowest = finite.front();
  summary.median = finite[(finite.size() - 1) / 2];
  return summary;
}

}  // namespace pierce::tool
