// SPDX-License-Identifier: Apache-2.0
//
// The classic ways to intersect one ray with one triangle, each a page with its source, its
// formulas, its cost and what it gets wrong. All share one signature:
//
//   template <class Scalar>
//   std::optional<TextbookHit<Scalar>> method(const Ray<Scalar>& ray, const Vec3<Scalar>& a,
//                                             const Vec3<Scalar>& b, const Vec3<Scalar>& c);
//
// Scalar is float, double, long double, or an exact rational (boost::multiprecision::cpp_rational,
// GMP's mpq_class). Over a rational all of them return the same: the definition of a hit, for
// closed triangles, where a ray in the plane of a triangle and a triangle without area never hit
// (moller_trumbore and its culling form with epsilon = 0; the latter for front faces only). Over
// floats each has its own errors: that is what they are here to show. Scene has none.
//
// A ray over an exact type has the default range [0, infinity), like every ray; its ends are of
// type Bound. `convert<To>(ray)` brings a ray to another scalar type. The direction must not be
// zero. NaN or infinite coordinates are not caught. Pure functions, no allocation for built-in
// types, safe from any thread.
//
// docs/textbook.md compares them; `pierce textbook` and `pierce triangle` run them.
#pragma once

#include "pierce/textbook/baldwin_weber.h"
#include "pierce/textbook/common.h"
#include "pierce/textbook/cramer.h"
#include "pierce/textbook/determinants.h"
#include "pierce/textbook/methods.h"
#include "pierce/textbook/moller_trumbore.h"
#include "pierce/textbook/plane_then_barycentric.h"
#include "pierce/textbook/plane_then_edges.h"
#include "pierce/textbook/precomputed_normal.h"
#include "pierce/textbook/watertight.h"
