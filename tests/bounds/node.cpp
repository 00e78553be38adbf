// SPDX-License-Identifier: Apache-2.0
//
// Boxes that a ray only just touches: in a corner, on an edge, on a face, at an end of its range.
#include <utility>

#include "bounds/siege.h"
#include "bounds/targets.h"
#include "support/show.h"

namespace pierce::siege {
namespace {

using hard::component;
using Vec = Vec3<double>;

/// On which axis the boxes are entered as they are left on another.
struct Axes {
  std::size_t in, out, rest;
};

/// Rounds the ray so that its copy enters later on the one axis and leaves sooner on the other.
void round_badly(const Axes& axes, double tau, RayD& ray) {
  const auto bad = [](double x, double sign) {  // float makes it more (sign > 0) or less
    const auto copy = static_cast<float>(x);
    const float next = std::nextafter(copy, sign > 0 ? -8.0F : 8.0F);
    const auto f = static_cast<double>(copy);
    return attack::on_grid(f + 0.4998 * (static_cast<double>(next) - f));
  };
  for (const auto& [axis, later] : {std::pair{axes.in, 1.0}, std::pair{axes.out, -1.0}}) {
    double& d = component(ray.direction, axis);
    const double forward = std::copysign(1.0, d);
    double& o = component(ray.origin, axis);
    o = std::clamp(bad(o, -later * forward), -2.0, 2.0);
    d = bad(d, -later * forward * std::copysign(1.0, tau));
  }
  if (attack::max_norm(ray.direction) < 1) component(ray.direction, axes.rest) = 1;
}

/// Nearly or quite along one axis, on which the origin lies on, or next to, a plane.
void run_along(Rng& rng, const Axes& axes, RayD& ray) {
  const double slope = rng.one_in(3) ? 0 : std::ldexp(1 + rng.unit(), -rng.between(30, 1070));
  component(ray.direction, axes.out) = rng.coin() ? slope : -slope;
  double& o = component(ray.origin, axes.out);
  o = std::clamp(static_cast<double>(static_cast<float>(o)) + rng.between(-2, 2) * 0x1p-55, -2.0,
                 2.0);
  if (rng.one_in(8)) o = std::ldexp(rng.symmetric(), -rng.between(100, 1000));
  if (attack::max_norm(ray.direction) < 1) component(ray.direction, axes.in) = 1;
}

/// The smallest distance of the float planes of entry and exit from the point, in tau, of a few.
Vec best_point(Rng& rng, const Axes& axes, const RayD& ray) {
  Vec best{};
  double least = kInfinity<double>;
  for (int i = 0; i < 4; ++i) {
    Vec p = draw_point(rng, ray);
    double slack = 0;
    for (const std::size_t axis : {axes.in, axes.out}) {
      const double x = component(p, axis);
      Vec d = ray.direction;
      slack += std::fabs((x - static_cast<double>(static_cast<float>(x))) / component(d, axis));
    }
    if (slack <= least || i == 0) best = p, least = slack;
  }
  return best;
}

/// A box that holds the point on its border.
FloatBox draw_box(Rng& rng, const Axes& axes, const RayD& ray, Vec p) {
  FloatBox box;
  Vec d = ray.direction;
  const int size = rng.between(0, 30);
  for (std::size_t k = 0; k < 3; ++k) {
    // As the builder rounds; but now and then what sticks out by a little is rounded away.
    const double x = std::clamp(component(p, k), -1.0, 1.0);
    const double inward = rng.coin() ? 0 : 0x1p-53;
    const auto thick = [&] { return rng.one_in(4) ? 0 : std::ldexp(rng.unit(), -size); };
    const bool forward = component(d, k) > 0 || (component(d, k) == 0 && rng.coin());
    const bool low_here = k == axes.in ? forward : k == axes.out ? !forward : rng.one_in(4);
    const bool high_here = k == axes.in ? !forward : k == axes.out ? forward : rng.one_in(4);
    const auto down = [](double y) { return exact::round_down(std::max(y, -1.0)); };
    const auto up = [](double y) { return exact::round_up(std::min(y, 1.0)); };
    box.lower[k] = down(low_here ? x + inward : x - thick());
    box.upper[k] = up(high_here ? x - inward : x + thick());
    if (box.lower[k] > box.upper[k]) box.upper[k] = box.lower[k];
  }
  return box;
}

void make_smaller(int k, RayD& ray, FloatBox (&boxes)[bvh::kWidth]) {
  std::vector<TriangleD> none;
  attack::make_smaller(k, ray, none);
  for (FloatBox& box : boxes) {
    for (float* planes : {box.lower, box.upper}) {
      for (int axis = 0; axis < 3; ++axis) planes[axis] = std::ldexp(planes[axis], -k);
    }
  }
}

bvh::Node node_of(const FloatBox (&boxes)[bvh::kWidth]) {
  bvh::Node node{};
  for (int i = 0; i < bvh::kWidth; ++i) {
    bvh::Box box;
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = boxes[i].lower[k];
      box.upper[k] = boxes[i].upper[k];
    }
    bvh::set_child_box(node, i, bvh::padded(box));
    node.child[i] = bvh::make_leaf(0, 1);
  }
  bvh::order_children(node);
  return node;
}

std::string text_of(const RayD& ray, const FloatBox& box) {
  std::string text = siege::text_of(ray, {});
  const auto add = [&text](const char* name, const float(&p)[3]) {
    text += name;
    text += show::text(Vec{static_cast<double>(p[0]), static_cast<double>(p[1]),
                           static_cast<double>(p[2])}) +
            "\n";
  };
  add("lower ", box.lower);
  add("upper ", box.upper);
  return text;
}

}  // namespace

std::string attack_node(Rng& rng, Counts& counts) {
  const Plan plan = draw_plan(rng);
  const std::size_t in = rng.below(3), out = (in + 1 + rng.below(2)) % 3;
  const Axes axes{in, out, 3 - in - out};
  RayD ray = draw_ray(rng, plan, attack::draw_place(rng));
  if (!plan.exact && rng.coin()) round_badly(axes, draw_tau(rng, ray), ray);
  if (rng.one_in(8)) run_along(rng, axes, ray);

  FloatBox boxes[bvh::kWidth];
  Vec first{};
  for (FloatBox& box : boxes) {
    const Vec p = best_point(rng, axes, ray);
    if (&box == boxes) first = p;
    box = draw_box(rng, axes, ray, p);
  }
  if (rng.one_in(4)) {
    const std::size_t k = std::fabs(component(ray.direction, axes.in)) > 0 ? axes.in : axes.rest;
    const double d = component(ray.direction, k);
    if (std::fabs(d) > 0.1) {
      end_near(rng, (component(first, k) - component(ray.origin, k)) / d, ray);
    }
  }
  if (rng.one_in(3)) make_smaller(rng.between(1, 26), ray, boxes);
  const Line line(ray);
  space::FilterRay filter = attack::filter_ray(ray, plan.exact);
  set_tight_range(ray, filter);
  const double tau_min = std::max(ray.t_min, -4.0), tau_max = std::min(ray.t_max, 4.0);

  const bvh::Node node = node_of(boxes);
  std::uint32_t touched = 0;
  double entry[bvh::kWidth] = {};
  for (std::uint32_t i = 0; i < bvh::kWidth; ++i) {
    const BoxPair pair(line, boxes[i], tau_min, tau_max);
    touched |= (pair.touches() ? 1U : 0U) << i;
    entry[i] = pair.entry();
    counts.touched += pair.touches() ? 1 : 0;
  }
  counts.boxes += bvh::kWidth;
  for (const Target& target : targets()) {
    float says[bvh::kWidth];
    const std::uint32_t entered = target.entered(node, filter, says);
    for (std::uint32_t i = 0; i < bvh::kWidth; ++i) {
      if (((touched >> i) & 1U) == 0) continue;
      const bool refused = ((entered >> i) & 1U) == 0;
      // A box that begins before the range is entered where that begins.
      const bool late = static_cast<double>(says[i]) > entry[i] && says[i] > filter.tau_min;
      if (!refused && !late) continue;
      return std::string(target.name) +
             (refused ? ": a box that is touched is refused\n" : ": a box is entered too late\n") +
             text_of(ray, boxes[i]);
    }
  }
  return {};
}

}  // namespace pierce::siege
