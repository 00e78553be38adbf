// SPDX-License-Identifier: Apache-2.0
//
// Triangles that a ray only just meets, or only just does not, or meets where its range ends.
#include "bounds/siege.h"
#include "bounds/targets.h"
#include "bvh/leaf_block.h"
#include "space/filter_space.h"
#include "support/show.h"

namespace pierce::siege {
namespace {

using attack::max_norm;
using attack::operator*;
using Vec = Vec3<double>;

/// A tree that is one leaf, written anew for each case.
class OneLeaf {
 public:
  OneLeaf() {
    tree_.leaves = bvh::HugeBuffer<std::byte>(kBytes + bvh::kLeafSlack);
    std::memset(tree_.leaves.data(), 0, kBytes + bvh::kLeafSlack);
  }
  const bvh::Tree& of(const std::vector<TriangleD>& corners) {
    const attack::Corners primitives(corners);
    const std::uint32_t numbers[bvh::kWidth] = {0, 1, 2, 3, 4, 5, 6, 7};
    bvh::write_leaf_block(bvh::Layout::Full, tree_.leaves.data(), primitives, numbers,
                          primitives.size());
    tree_.root = bvh::make_leaf(0, primitives.size());
    return tree_;
  }

 private:
  static constexpr std::size_t kBytes = 512;
  bvh::Tree tree_;
};

/// What a target says wrongly of the leaf, or nullptr.
const char* first_error(const LeafSays& says, const std::vector<Pair>& pairs, std::uint32_t hit) {
  if ((hit & ~says.open) != 0) return "a hit is discarded";
  if ((says.certain & ~hit) != 0) return "certain of a miss";
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    if (((says.certain >> i) & 1U) == 0) continue;
    if (pairs[i].compare_tau(says.tau_low[i]) < 0) return "a hit lies before its interval";
    if (pairs[i].compare_tau(says.tau_high[i]) > 0) return "a hit lies beyond its interval";
  }
  return nullptr;
}

/// Asks all targets about one ray and the triangles (`scene`), whose images in filter space are
/// `corners`.
std::string ask(const Line& line, const std::vector<TriangleD>& scene,
                const std::vector<TriangleD>& corners, const space::FilterRay& filter,
                Counts& counts) {
  static thread_local OneLeaf kLeaf;
  std::vector<Pair> pairs;
  pairs.reserve(scene.size());
  std::uint32_t hit = 0, front = 0;
  for (const TriangleD& t : scene) {
    pairs.emplace_back(line, t);
    if (!pairs.back().hit()) continue;
    const std::uint32_t bit = 1U << (pairs.size() - 1);
    hit |= bit;
    if (pairs.back().facing() == Facing::Front) front |= bit;
  }
  counts.triangles += pairs.size();
  counts.hit += static_cast<std::uint64_t>(std::popcount(hit));
  const bvh::Tree& tree = kLeaf.of(corners);
  for (const Target& target : targets()) {
    const LeafSays says = target.cull(tree, tree.root, filter);
    if (&target == targets().data()) {
      counts.certain += static_cast<std::uint64_t>(std::popcount(says.certain));
    }
    const char* error = first_error(says, pairs, hit);
    for (const Sides sides : {Sides::Front, Sides::Back}) {
      space::FilterRay sided = filter;
      sided.sides = sides;
      const std::uint32_t seen = sides == Sides::Front ? front : hit & ~front;
      if (error == nullptr) error = first_error(target.cull(tree, tree.root, sided), pairs, seen);
    }
    if (error == nullptr) continue;
    return std::string(target.name) + ": " + error + "\n" + text_of(line.ray(), scene);
  }
  return {};
}

/// Numbers far below the others: what is next to nothing beside the box.
void make_tiny(Rng& rng, RayD& ray, std::vector<TriangleD>& triangles) {
  const auto tiny = [&] { return std::ldexp(rng.symmetric(), -rng.between(56, 1073)); };
  if (rng.coin()) {
    const double small = rng.coin() ? tiny() : std::ldexp(rng.symmetric(), -rng.between(120, 150));
    hard::component(ray.direction, rng.below(3)) = small;
    if (max_norm(ray.direction) < 1) ray.direction.y = 1;
  }
  if (rng.coin()) hard::component(ray.origin, rng.below(3)) = tiny();
  const int by = -rng.between(40, 150);
  for (TriangleD& t : triangles) {
    if (!rng.coin()) continue;
    for (Vec* p : {&t.a, &t.b, &t.c}) {
      *p = {std::ldexp(p->x, by), std::ldexp(p->y, by), std::ldexp(p->z, by)};
    }
  }
  if (rng.coin()) {
    ray.origin = triangles[0].a;
    const double tau = 0.5 * rng.between(-1, 1);
    ray.origin = {ray.origin.x - tau * ray.direction.x, ray.origin.y - tau * ray.direction.y,
                  ray.origin.z - tau * ray.direction.z};
  }
}

TriangleD rotated(Rng& rng, const TriangleD& t) {
  switch (rng.below(6)) {
    case 0:
      return {t.b, t.c, t.a};
    case 1:
      return {t.c, t.a, t.b};
    case 2:
      return {t.b, t.a, t.c};
    case 3:
      return {t.a, t.c, t.b};
    case 4:
      return {t.c, t.b, t.a};
    default:
      return t;
  }
}

}  // namespace

std::string text_of(const RayD& ray, const std::vector<TriangleD>& triangles) {
  std::string text = "origin " + show::text(ray.origin) + "\ndirection " +
                     show::text(ray.direction) + "\nrange " + show::text(ray.t_min) + " .. " +
                     show::text(ray.t_max) + (ray.open_start ? " open\n" : "\n");
  for (const TriangleD& t : triangles) {
    text += show::text(t.a) + " " + show::text(t.b) + " " + show::text(t.c) + "\n";
  }
  return text;
}

std::string attack_leaf(Rng& rng, Counts& counts) {
  const Plan plan = draw_plan(rng);
  const Vec target = attack::on_grid(attack::draw_place(rng));
  const bool exactly = !plan.exact && rng.one_in(4);
  RayD ray = exactly ? draw_exact_ray(rng, target) : draw_ray(rng, plan, target);
  const auto count = rng.coin() ? bvh::kWidth : static_cast<int>(rng.between(1, bvh::kWidth));
  const bool together = rng.coin();
  const std::uint64_t how = plan.exact || exactly ? 0 : rng.below(4);
  std::vector<TriangleD> triangles;
  for (int i = 0; i < count; ++i) {
    const Vec point = i == 0 || together ? target : draw_point(rng, ray);
    TriangleD t =
        how == 3 ? draw_around(rng, plan, ray, point) : draw_touched(rng, plan, ray, point);
    if (how == 1 || how == 2) round_edge_badly(rng, i == 0, ray, t);
    if (how == 3) round_place_badly(rng, i == 0, ray, t);
    triangles.push_back(rotated(rng, t));
  }
  if (rng.one_in(64)) make_tiny(rng, ray, triangles);
  if (how == 3 || rng.one_in(3)) end_near(rng, place_of(ray, triangles[0]), ray);
  if (rng.one_in(4)) end_near(rng, place_of(ray, triangles.back()), ray);
  if (rng.one_in(3)) attack::make_smaller(rng.between(1, 26), ray, triangles);
  space::FilterRay filter = attack::filter_ray(ray, plan.exact);
  for (const TriangleD& t : triangles) filter.exact = filter.exact && attack::is_float(t);
  if (rng.coin()) set_tight_range(ray, filter);
  return ask(Line(ray), triangles, triangles, filter, counts);
}

std::string attack_leaf_from_afar(Rng& rng, Counts& counts) {
  // A scene somewhere, about as large as 2^k: filter space is (x - center) 2^-k.
  const int k = rng.one_in(4) ? rng.between(-300, 300) : rng.between(-8, 8);
  const double unit = std::ldexp(1.0, k), reach = 0.75 * unit;
  const auto somewhere = [&] {
    const double units = std::trunc(std::ldexp(rng.symmetric(), rng.between(4, 30)));
    return std::fabs(units) < 4 ? 0 : unit * units;  // nearer, the space would stay about 0
  };
  const Vec center = rng.coin() ? Vec{} : Vec{somewhere(), somewhere(), somewhere()};
  const space::FilterSpace space({center.x - reach, center.y - reach, center.z - reach},
                                 {center.x + reach, center.y + reach, center.z + reach});
  const auto out = [&](const Vec& p) {
    return Vec{center.x + unit * p.x, center.y + unit * p.y, center.z + unit * p.z};
  };
  // From 2 to 2^60 box sizes away; then where it really runs by the box.
  Plan plan = draw_plan(rng);
  plan.exact = false;
  RayD ray = draw_ray(rng, plan, 0.7 * attack::draw_place(rng));
  const double far = std::ldexp(1 + rng.unit(), rng.between(-2, rng.one_in(4) ? 60 : 20));
  const Vec inside = 0.5 * draw_point(rng, ray);
  const double length =
      std::ldexp(1.0, rng.one_in(4) ? rng.between(-300, 300) : rng.between(-4, 4));
  ray.direction = length * ray.direction;
  const Vec& d = ray.direction;
  const double back = far / length;
  ray.origin = out({inside.x - back * d.x, inside.y - back * d.y, inside.z - back * d.z});
  const space::TransformedRay line = space.transform(ray);
  if (line.misses) return {};
  RayD near{line.origin, line.direction, -kInfinity<double>, kInfinity<double>, false};

  std::vector<TriangleD> scene, corners;
  for (int i = 0; i < 4; ++i) {
    const Vec point = draw_point(rng, near);
    if (!(max_norm(point) <= 0.75)) continue;
    TriangleD t = draw_touched(rng, plan, near, point);
    if (rng.coin()) round_edge_badly(rng, false, near, t);
    t = {out(t.a), out(t.b), out(t.c)};
    const TriangleD image{space.map(t.a), space.map(t.b), space.map(t.c)};
    if (std::max({max_norm(image.a), max_norm(image.b), max_norm(image.c)}) > 1) continue;
    scene.push_back(t);
    corners.push_back(image);
  }
  if (scene.empty()) return {};
  if (rng.coin()) {
    const double t = place_of(ray, scene[0]);
    (rng.coin() ? ray.t_min : ray.t_max) =
        std::isfinite(t) ? hard::nudged(t, rng.between(-2, 2)) : 0;
    ray.open_start = rng.one_in(4);
  }
  const space::TransformedRay transformed = space.transform(ray);
  const space::FilterRay filter = space::filter_ray(transformed, false);
  return ask(Line(ray, transformed, center), scene, corners, filter, counts);
}

}  // namespace pierce::siege
