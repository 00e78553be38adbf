// SPDX-License-Identifier: Apache-2.0
//
// The nearest triangles, several of them: those that bounds cannot exclude are collected, then put
// in order exactly.
#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <vector>

#include "bvh/leaf_access.h"
#include "kernels/points/axis.h"
#include "predicate/nearest.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/finite.h"
#include "support/float_environment.h"

namespace pierce {
namespace {

// What bounds leave of the search.
class NearestSearch {
 public:
  struct Found {
    predicate::NearTriangle near;
    std::uint32_t primitive;
  };

  template <class Real>
  NearestSearch(const scene::Geometries<Real>& geometries, const bvh::Tree& tree, bool repeats,
                const Vec3<double>& point, std::uint64_t most, double radius)
      : tree_(tree), repeats_(repeats), most_(most) {
    const Vec3<double> p = geometries.space().map(point);
    at_[0] = p.x;
    at_[1] = p.y;
    at_[2] = p.z;
    const auto length = [&](double x) { return geometries.space().map_length(x) * (1 + 0x1p-40); };
    limit_ = length(radius);
    if (most == 0 || tree.root == bvh::kNoChild) return;
    todo_.push({0, tree.root});
    while (!todo_.empty()) {
      const Todo next = todo_.top();
      todo_.pop();
      if (next.distance > limit_) break;  // and so are all the others
      if (!bvh::is_leaf(next.ref)) {
        open(next.ref);
        continue;
      }
      const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree, next.ref);
      for (std::uint32_t i = 0; i < bvh::leaf_count(next.ref); ++i) {
        if (repeats_ && !met_.add(numbers[i])) continue;
        found_.push_back(
            {predicate::decide_near(point, geometries.triangle(numbers[i]), counts_), numbers[i]});
        note(found_.back().near.squared.high, length);
      }
    }
  }

  [[nodiscard]] std::vector<Found>& found() { return found_; }
  [[nodiscard]] predicate::LadderCounts& counts() { return counts_; }
  /// The distance, squared, that surely as many triangles as are wanted have or are below.
  [[nodiscard]] double enough() const {
    return highs_.size() == most_ ? highs_.top() : kInfinity<double>;
  }

 private:
  struct Todo {
    double distance;
    std::uint32_t ref;
    bool operator<(const Todo& other) const { return distance > other.distance; }
  };

  void open(std::uint32_t ref) {
    const bvh::Node& node = tree_.nodes[ref];
    for (int child = 0; child < bvh::kWidth && node.child[child] != bvh::kNoChild; ++child) {
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double pad = 0x1p-44 * (1 + std::fabs(at_[axis]));
        const double off = std::max(static_cast<double>(node.lower[axis][child]) - at_[axis],
                                    at_[axis] - static_cast<double>(node.upper[axis][child])) -
                           pad;
        if (off > 0) square += off * off;
      }
      const double distance = std::sqrt(square) * (1 - 0x1p-40);
      // A point that is too far away for filter space tells nothing apart.
      const double sure = is_infinite(distance) || is_nan(distance) ? 0 : distance;
      if (sure <= limit_) todo_.push({sure, node.child[child]});
    }
  }

  template <class Length>
  void note(double high, const Length& length) {
    if (most_ == kUnlimited) return;
    if (highs_.size() == most_) {
      if (high >= highs_.top()) return;
      highs_.pop();
    }
    highs_.push(high);
    if (highs_.size() == most_ && !is_infinite(highs_.top())) {
      limit_ = std::min(limit_, length(std::sqrt(highs_.top())));
    }
  }

  const bvh::Tree& tree_;
  const bool repeats_;
  const std::uint64_t most_;
  double at_[3];
  double limit_;
  std::priority_queue<Todo> todo_;
  std::priority_queue<double> highs_;  // upper bounds of the nearest ones' squares, so many
  kernels::MetTriangles met_;
  std::vector<Found> found_;
  predicate::LadderCounts counts_;
};

}  // namespace

template <class Real>
void Scene<Real>::nearest_triangles(const Vec3<Real>& point, std::uint64_t most,
                                    std::vector<NearestPoint<Real>>& out, Real radius) const {
  const FloatEnvironment environment;
  scene::validate_point(point);
  if (!(radius >= 0)) {
    throw Error(ErrorCode::InvalidArgument,
                std::string("the radius ") + (is_nan(radius) ? "is not a number" : "is negative") +
                    "; give 0 or more, or infinity for no limit");
  }
  impl_->require_flat("several nearest triangles");
  const Vec3<double> p = predicate::to_double(point);
  const scene::Geometries<Real>& geometries = impl_->geometries;
  NearestSearch search(geometries, impl_->tree,
                       impl_->surface->repeats(impl_->tree, geometries.size()), p, most,
                       static_cast<double>(radius));
  auto& found = search.found();
  std::erase_if(found, [&](const NearestSearch::Found& one) {
    return one.near.squared.low > search.enough() ||
           !predicate::decide_within(p, one.near, static_cast<double>(radius), search.counts());
  });
  std::sort(found.begin(), found.end(),
            [&](const NearestSearch::Found& a, const NearestSearch::Found& b) {
              const auto order = predicate::decide_nearer(p, a.near, b.near, search.counts());
              return order != 0 ? order < 0 : a.primitive < b.primitive;
            });
  if (found.size() > most) found.resize(static_cast<std::size_t>(most));
  out.clear();
  out.reserve(found.size());
  for (const NearestSearch::Found& one : found) {
    NearestPoint<Real> result = predicate::round_nearest<Real>(p, one.near, search.counts());
    const TriangleRef ref = geometries.ref(one.primitive);
    result.geometry = ref.geometry;
    result.triangle = ref.triangle;
    out.push_back(environment.made(result));
  }
}

template void Scene<float>::nearest_triangles(const Vec3<float>&, std::uint64_t,
                                              std::vector<NearestPoint<float>>&, float) const;
template void Scene<double>::nearest_triangles(const Vec3<double>&, std::uint64_t,
                                               std::vector<NearestPoint<double>>&, double) const;

}  // namespace pierce
