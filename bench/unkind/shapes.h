// SPDX-License-Identifier: Apache-2.0
//
// What unkind scenes are put together from. Deterministic, from fixed seeds, the same on every
// machine.
#pragma once

#include "unkind/subject.h"
#include "workloads/prng.h"

namespace pierce::bench {

/// Hills of 0.1 over the square from -15 to 15, n x n cells: where robots drive.
Shape hills(unsigned n);
/// The square from -size / 2 to size / 2 at height z, n x n cells.
Shape square(double size, double z, unsigned n = 1);
/// n x n cells of two triangles between the last (n + 1) x (n + 1) vertices.
void add_cells(Shape& shape, unsigned n);
/// A closed sphere: an icosahedron, each triangle divided into four `levels` times.
Shape sphere(int levels, double radius = 1, const Double3& centre = {0, 0, 0});
/// Twelve triangles.
Shape cube(double size, const Double3& centre = {0, 0, 0});
/// `count` tetrahedra, the longest edge along `length`, the others up to `width` long, their first
/// corners anywhere in the cube from -reach to reach.
Shape splinters(unsigned count, double reach, const std::function<Double3(Prng&)>& length,
                double width);
/// Triangles from one corner of a square of side 1000 to its opposite side.
Shape fan(unsigned count);
/// `count` large triangles over the unit square, a step apart in z, each a little askew.
Shape layers(unsigned count, double step);

void append(Shape& shape, const Shape& more);
Shape both(Shape shape, const Shape& more);
Shape moved(Shape shape, const Double3& by);

using Rays = std::vector<Ray<double>>;
using Points = std::vector<Double3>;

/// From a mast in the hills, all around, mostly downwards.
Rays lidar(unsigned count);
/// Straight down onto the hills.
Rays height_scan(unsigned count);
/// From `origins` to points in the ball of that radius around 0, directions of length 1.
Rays aimed(unsigned count, double radius, const std::function<Double3(Prng&)>& origin);
/// From inside the ball of that radius in all directions.
Rays from_inside(unsigned count, double radius);

/// In a box.
Double3 anywhere(Prng& random, const Double3& lower, const Double3& upper);
/// At a distance from 0 between these.
Double3 in_shell(Prng& random, double inner, double outer);
Points scattered(unsigned count, const Double3& lower, const Double3& upper);

Subject asked(Shape shape, Rays rays);
Subject located(Shape shape, Points points);

}  // namespace pierce::bench
