// SPDX-License-Identifier: Apache-2.0
//
// Rays in filter space, and triangles that they only just meet: in a corner, on an edge, in a
// sliver or a needle, in a plane that they all but lie in; of every size; exactly so, or with every
// number rounded to where it hurts most.
#pragma once

#include "support/leaf_attacks.h"

namespace pierce::siege {

using attack::Plan;
using hard::Rng;
using predicate::RayD;
using predicate::TriangleD;

/// A plan: all numbers floats or not, and the size of edges.
Plan draw_plan(Rng& rng);

/// A ray through `target` (but for a rounding) from within 2 of the centre.
RayD draw_ray(Rng& rng, const Plan& plan, const Vec3<double>& target);

/// A ray exactly through `target`, which is on the grid.
RayD draw_exact_ray(Rng& rng, const Vec3<double>& target);

/// The point at tau, on the grid. May lie outside the box.
Vec3<double> point_at(const RayD& ray, double tau);

/// A tau at which the ray is in the box [-1, 1]^3, if there is one.
double draw_tau(Rng& rng, const RayD& ray);

/// A point of the ray in that box; else one of the box.
Vec3<double> draw_point(Rng& rng, const RayD& ray);

/// A triangle with the point well within; half of them all but along the ray.
TriangleD draw_around(Rng& rng, const Plan& plan, const RayD& ray, const Vec3<double>& point);

/// A triangle in the box that only just meets the ray at `point`, or only just does not.
TriangleD draw_touched(Rng& rng, const Plan& plan, const RayD& ray, const Vec3<double>& point);

/// A triangle whose corner a is at `point`, where its box is entered on one axis as it is left on
/// another.
TriangleD draw_box_corner(Rng& rng, const Plan& plan, const RayD& ray, const Vec3<double>& point);

/// Rounds the ray (if `with_ray`) and the triangle so that the float copies' edge a b is as far off
/// as can be, seen along the ray, and puts the true edge back to where the ray is.
void round_edge_badly(Rng& rng, bool with_ray, RayD& ray, TriangleD& t);

/// Rounds the ray (if `with_ray`) and the triangle so that the float copies are met as early, or as
/// late, as can be.
void round_place_badly(Rng& rng, bool with_ray, RayD& ray, TriangleD& t);

/// Where the ray's line meets the triangle's plane, nearly.
double place_of(const RayD& ray, const TriangleD& t);

}  // namespace pierce::siege
