// SPDX-License-Identifier: Apache-2.0
//
// The box test may only leave out a box that the ray misses. Attacked with rays that hit a triangle
// in a corner or on an edge of its box, so that they touch the box at a point, from far away and
// near, along the axes and nearly so, in boxes of every size and without thickness; and with ranges
// that end there. 10^5 attacks of each kind in ctest; the long run is
//   PIERCE_CASES=10000000 property_box_test_test
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "support/leaf_attacks.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using attack::Aim;
using attack::LeafCase;
using attack::Plan;
using hard::Rng;

// By how much the computed entry into the box of a triangle is after the exit, in units of what the
// bounds allow (kBoxPlane of planes, kBoxOrigin of origins). Only a guide: it picks cases.
double gap(const LeafCase& c) {
  const predicate::TriangleD& t = c.triangles.front();
  const bvh::Box box = bvh::box_of({t.a, t.b, t.c});
  const space::FilterRay ray = attack::filter_ray(c.ray, false);
  double gap = 0;
  for (std::size_t in = 0; in < 3; ++in) {
    for (std::size_t out = 0; out < 3; ++out) {
      const float in_inverse = 1 / ray.direction[in], out_inverse = 1 / ray.direction[out];
      const float near = in_inverse > 0 ? box.lower[in] : box.upper[in];
      const float far = out_inverse > 0 ? box.upper[out] : box.lower[out];
      const float entry = near * in_inverse - ray.origin[in] * in_inverse;
      const float exit = far * out_inverse - ray.origin[out] * out_inverse;
      const auto pad = [&](float plane, std::size_t axis, float inverse) {
        const auto wider = static_cast<float>(bounds::kBoxPlane) * std::fabs(plane);
        return (wider + bounds::kBoxOrigin * std::fabs(ray.origin[axis]) + bounds::kBoxFloor) *
               std::fabs(inverse);
      };
      const float pads = pad(near, in, in_inverse) + pad(far, out, out_inverse);
      gap = std::max(gap, static_cast<double>((entry - exit) / pads));
    }
  }
  return gap;
}

// The corner a on an edge of the triangle's box, and a ray that touches the box there only: on one
// axis it leaves where on the other it enters.
attack::Genes touching(Rng& rng, const Plan& plan) {
  attack::Genes g = attack::draw_genes(rng, plan);
  const std::size_t x = rng.below(3), y = (x + 1) % 3, z = (x + 2) % 3;
  using hard::component;
  g.triangle.a = attack::rounded(g.triangle.a);  // its planes are not rounded outward
  const double size = std::ldexp(1 + rng.unit(), -plan.size);
  for (Vec3<double>* p : {&g.triangle.b, &g.triangle.c}) {
    for (const std::size_t axis : {x, y}) {
      const double a = component(g.triangle.a, axis);
      component(*p, axis) = attack::on_grid(a - std::copysign(size * rng.unit(), a));
    }
    const double a = component(g.triangle.a, z);
    const double off = p == &g.triangle.b ? size : -size;
    component(*p, z) = attack::on_grid(std::clamp(a + off * rng.unit(), -1.0, 1.0));
  }
  const double inward = component(g.triangle.a, x) * component(g.triangle.a, y);
  double& dy = component(g.direction, y);
  dy = std::copysign(dy, -inward * component(g.direction, x));
  g.at = {0, 0};
  return g;
}

// The corners of the triangle's box are where the ray goes: through a vertex, or through a point of
// an edge where the triangle is flat.
LeafCase draw_any(Rng& rng, const Plan& plan) {
  attack::Genes genes = attack::draw_genes(rng, plan);
  if (rng.coin()) genes.at = rng.coin() ? attack::Weights{0, 0} : attack::Weights{1, 0};
  if (rng.one_in(4)) {  // a box without thickness
    const std::size_t axis = rng.below(3);
    using hard::component;
    component(genes.triangle.b, axis) = component(genes.triangle.a, axis);
    component(genes.triangle.c, axis) = component(genes.triangle.a, axis);
  }
  if (rng.one_in(4)) {  // nearly along an axis, around the smallest slope
    const std::size_t axis = rng.below(3);
    const double small = std::ldexp(attack::signed_unit(rng), -rng.between(20, 140));
    hard::component(genes.direction, (axis + 1) % 3) = small;
    if (rng.coin()) hard::component(genes.direction, (axis + 2) % 3) = rng.coin() ? 0.0 : -small;
    hard::component(genes.direction, axis) = attack::signed_unit(rng) * (1 + rng.unit() / 2);
  }
  LeafCase c = attack::make_case(genes, plan);
  if (rng.one_in(4)) (rng.coin() ? c.ray.t_min : c.ray.t_max) = genes.tau;
  if (rng.coin()) attack::make_smaller(rng.between(1, 26), c.ray, c.triangles);
  return c;
}

LeafCase draw(Rng& rng) {
  const Plan plan{Aim::DiscardHit, rng.one_in(4), rng.between(0, 25)};
  if (rng.coin()) return draw_any(rng, plan);
  // Of some that touch and hit, the one with the widest gap.
  LeafCase best = draw_any(rng, plan);
  double widest = -1;
  for (int i = 0; i < 16; ++i) {
    const LeafCase c = attack::make_case(touching(rng, plan), plan);
    if (!predicate::settle_hit(c.ray, c.triangles.front()).hit) continue;
    const double wide = gap(c);
    if (wide <= widest) continue;
    best = c;
    widest = wide;
  }
  return best;
}

TEST(BoxTest, a_box_that_is_touched_in_one_point_is_entered) {
  std::atomic<std::uint64_t> hits = 0;
  const std::uint64_t count = hard::case_count(100000);
  std::atomic<const char*> kernel_name = "";
  const auto failure = hard::first_failure(count, [&](std::uint64_t i) {
    Rng rng(hard::seed() + 50, i);
    const LeafCase c = draw(rng);
    const attack::Truth truth(c);
    if (truth.hits == 0) return false;
    ++hits;
    const bvh::Tree tree = attack::one_node(c.triangles);
    std::uint64_t asked = 0;
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      if (attack::first_error(*kernel, tree, c, truth, false, asked) == nullptr) continue;
      kernel_name = kernel->name;
      return true;
    }
    return false;
  });
  if (failure) {
    Rng rng(hard::seed() + 50, *failure);
    const LeafCase c = draw(rng);
    FAIL() << "seed " << hard::seed() << " attack " << *failure << ": " << kernel_name.load()
           << " does not enter the box of\n"
           << show::text(c.triangles[0].a) << show::text(c.triangles[0].b)
           << show::text(c.triangles[0].c) << "\nfrom " << show::text(c.ray.origin) << " along "
           << show::text(c.ray.direction);
  }
  if (hard::enough_cases(100000)) {
    EXPECT_GT(hits, count / 10);
  }
}

TEST(BoxTest, an_empty_box_is_never_entered) {
  // The unused lanes of a node: were one entered, the kernel would follow a reference to nothing.
  const std::vector<predicate::TriangleD> triangles = {{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}}};
  const bvh::Tree tree = attack::one_node(triangles);
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      for (const double slope : {0.0, -0.0, 1e-300, -1e-20, 1.0, -1.0}) {
        LeafCase c{{{x, 0.125, -2}, {slope, -slope, 1}}, triangles};
        c.ray.t_max = kInfinity<double>;
        std::uint64_t asked = 0;
        const char* error = attack::first_error(*kernel, tree, c, attack::Truth(c), false, asked);
        EXPECT_EQ(error, nullptr) << kernel->name << ": " << error;
      }
    }
  }
}

}  // namespace
}  // namespace pierce
