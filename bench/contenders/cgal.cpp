// SPDX-License-Identifier: Apache-2.0
//
// CGAL's AABB tree over the kernel that its own manual recommends (exact predicates, inexact
// constructions): exact hits, rounded points. So much slower that it answers only a part of a set.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "contenders/families.h"
#include "contenders/parallel.h"
#include "contenders/ray_by_ray.h"

namespace pierce::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>>;

Kernel::Point_3 to_point(const Vec3<double>& p) { return {p.x, p.y, p.z}; }

class CgalEngine : public Engine {
 public:
  using Engine::Engine;

  BuildFigures build(const Mesh& mesh, unsigned /*threads: its build knows none*/) override {
    release();
    const auto start = std::chrono::steady_clock::now();
    triangles_.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles_.emplace_back(to_point(to_double(mesh.vertices[a])),
                              to_point(to_double(mesh.vertices[b])),
                              to_point(to_double(mesh.vertices[c])));
    }
    tree_.emplace(triangles_.cbegin(), triangles_.cend());
    tree_->build();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const std::size_t n = triangles_.size();
    // Its triangles, and what CGAL documents: a primitive a triangle and a node a pair.
    const std::size_t bytes = n * (sizeof(Kernel::Triangle_3) + sizeof(Tree::Primitive)) +
                              (n - 1) * sizeof(CGAL::AABB_node<Tree::AABB_traits>);
    return {time.count(), bytes, 0};
  }

  void release() override {
    tree_.reset();
    triangles_ = {};
  }

  [[nodiscard]] std::uint64_t most_triangles() const override { return 10'000'000; }
  [[nodiscard]] const Tree& tree() const { return *tree_; }
  [[nodiscard]] std::uint32_t index_of(Iterator place) const {
    return static_cast<std::uint32_t>(place - triangles_.cbegin());
  }

 private:
  std::vector<Kernel::Triangle_3> triangles_;
  std::optional<Tree> tree_;
};

class CgalContender : public RayByRay<double> {
 public:
  CgalContender(std::string name, CgalEngine& engine)
      : RayByRay(std::move(name), engine), cgal_(engine) {}

  [[nodiscard]] std::size_t most_rays() const override { return 1U << 14; }

  void run() override {
    in_chunks(rays_.size(), threads_, [this](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) query_ == Query::Closest ? closest(i) : any(i);
    });
  }

 private:
  static Kernel::Vector_3 direction_of(const Ray<double>& ray) {
    return {ray.direction.x, ray.direction.y, ray.direction.z};
  }

  // The sets of the benchmark have t_min = 0, where CGAL's rays and segments begin, too.
  void closest(std::size_t i) {
    const Ray<double>& ray = rays_[i];
    const Kernel::Ray_3 query(to_point(ray.origin), direction_of(ray));
    const auto found = cgal_.tree().first_intersected_primitive(query);
    hits_[i] = {};
    if (!found) return;
    const Kernel::Plane_3 plane = (*found)->supporting_plane();
    const Kernel::Vector_3 normal = plane.orthogonal_vector();
    const double t = normal * ((**found)[0] - to_point(ray.origin)) / (normal * direction_of(ray));
    if (t > ray.t_max) return;
    hits_[i].t = static_cast<float>(t);
    hits_[i].triangle = cgal_.index_of(*found);
    hits_[i].geometry = 0;
  }

  void any(std::size_t i) {
    const Ray<double>& ray = rays_[i];
    const Kernel::Point_3 origin = to_point(ray.origin);
    if (std::isinf(ray.t_max)) {
      any_[i] = cgal_.tree().do_intersect(Kernel::Ray_3(origin, direction_of(ray))) ? 1 : 0;
    } else {
      const Kernel::Segment_3 query(origin, origin + ray.t_max * direction_of(ray));
      any_[i] = cgal_.tree().do_intersect(query) ? 1 : 0;
    }
  }

  CgalEngine& cgal_;
};

}  // namespace

bool add_cgal(Field& field, const std::string& name) {
  if (name != "cgal") return false;
  auto& engine = shared_engine<CgalEngine>(field, name);
  field.contenders.push_back(std::make_unique<CgalContender>(name, engine));
  return true;
}

std::string cgal_version() { return CGAL_VERSION_STR; }

}  // namespace pierce::bench
