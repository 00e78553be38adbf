// SPDX-License-Identifier: Apache-2.0
//
// CGAL's AABB tree over exact predicates and inexact constructions, as its manual recommends.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "inside/cgal_inside.h"
#include "unkind/ways.h"

namespace pierce::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>>;

constexpr std::size_t kMostQuestions = 256;

// The number that pierce is given.
Double3 rounded(const Double3& p, bool in_double) { return in_double ? p : to_double(to_float(p)); }

class CgalAsked {
 public:
  CgalAsked(const Subject& subject, Ask ask) : ask_(ask) {
    const auto point = [&](const Double3& p) {
      const Double3 q = rounded(p, subject.in_double);
      return Kernel::Point_3(q.x, q.y, q.z);
    };
    const std::vector<Double3>& vertices =
        subject.moved.empty() ? subject.shape.vertices : subject.moved;
    for (const auto& [a, b, c] : subject.shape.triangles)
      triangles_.emplace_back(point(vertices[a]), point(vertices[b]), point(vertices[c]));
    tree_.rebuild(triangles_.cbegin(), triangles_.cend());
    if (ask == Ask::Nearest) tree_.accelerate_distance_queries();
    for (const Ray<double>& r : subject.rays) {
      const Double3 d = rounded(r.direction, subject.in_double);
      rays_.emplace_back(point(r.origin), Kernel::Vector_3(d.x, d.y, d.z));
      directions_.emplace_back(d.x, d.y, d.z);
    }
    for (const Double3& p : subject.points) points_.push_back(point(p));
  }

  [[nodiscard]] std::size_t count() const {
    return std::min(kMostQuestions, std::max(rays_.size(), points_.size()));
  }

  void answer(std::vector<double>& answers) {
    for (std::size_t i = 0; i < count(); ++i) answers[i] = one(i);
  }

 private:
  double one(std::size_t i) {
    if (ask_ == Ask::Closest) return closest(i);
    if (ask_ == Ask::Nearest) return std::sqrt(tree_.squared_distance(points_[i]));
    return static_cast<double>(tree_.number_of_intersected_primitives(rays_[i]));
  }

  double closest(std::size_t i) {
    const auto found = tree_.first_intersected_primitive(rays_[i]);
    if (!found) return kInfinity<double>;
    const Kernel::Vector_3 normal = (*found)->supporting_plane().orthogonal_vector();
    return normal * ((**found)[0] - rays_[i].source()) / (normal * directions_[i]);
  }

  Ask ask_;
  std::vector<Kernel::Triangle_3> triangles_;
  Tree tree_;
  std::vector<Kernel::Ray_3> rays_;
  std::vector<Kernel::Vector_3> directions_;
  std::vector<Kernel::Point_3> points_;
};

struct Solid {
  std::vector<Vec3<float>> vertices, points;
  std::vector<Location> locations;
  std::unique_ptr<CgalInside> inside;
};

void add_inside(const Subject& subject, std::vector<Way>& ways) {
  if (subject.in_double || subject.open_mesh) return;
  const auto solid = std::make_shared<Solid>();
  for (const Double3& p : subject.shape.vertices) solid->vertices.push_back(to_float(p));
  const std::size_t count = std::min(kMostQuestions, subject.points.size());
  for (std::size_t i = 0; i < count; ++i) solid->points.push_back(to_float(subject.points[i]));
  solid->locations.resize(count);
  try {
    solid->inside =
        std::make_unique<CgalInside>(MeshView<float>{solid->vertices, subject.shape.triangles});
  } catch (const std::runtime_error&) {
    return;  // no manifold
  }
  ways.push_back({"cgal", count, [solid](std::vector<double>& answers) {
                    solid->inside->locate(solid->points, solid->locations);
                    std::transform(solid->locations.begin(), solid->locations.end(),
                                   answers.begin(),
                                   [](Location l) { return static_cast<double>(l); });
                  }});
}

}  // namespace

void add_cgal_way(const Subject& subject, Ask ask, std::vector<Way>& ways) {
  if (subject.sides != Sides::Both || subject.hidden != 0) return;  // it knows neither
  if (ask == Ask::Locate) return add_inside(subject, ways);
  if (ask != Ask::Closest && ask != Ask::Count && ask != Ask::Nearest) return;
  const auto asked = std::make_shared<CgalAsked>(subject, ask);
  ways.push_back({"cgal", asked->count(), [asked](std::vector<double>& a) { asked->answer(a); }});
}

}  // namespace pierce::bench
