// SPDX-License-Identifier: Apache-2.0
//
// Answers in words, and as JSON: for questions that were asked on the command line.
#pragma once

#include <string>

#include "io/json_writer.h"
#include "pierce/nearest.h"
#include "pierce/types.h"

namespace pierce::tool {

/// The part of the triangle that a ray pierces, decided exactly: u = 0 of a Hit may be a very small
/// number that was rounded.
template <class Real>
[[nodiscard]] Feature hit_feature(const Hit<Real>& hit, const Ray<Real>& ray, MeshView<Real> mesh);

/// "face", "edge ab", "vertex c".
[[nodiscard]] const char* name_of(Feature feature);

/// "hits edge ab of triangle 3 of geometry 0, front, at t = 1: u = 0.5, v = 0, w = 0.5", or
/// "misses".
template <class Real>
[[nodiscard]] std::string to_words(const Hit<Real>& hit, Feature feature);
[[nodiscard]] std::string to_words(const Crossings& crossings);
[[nodiscard]] const char* to_words(Location location);  ///< "inside", "on the surface", "outside"
template <class Real>
[[nodiscard]] std::string to_words(const NearestPoint<Real>& nearest);

/// The same as members of the object that is open.
template <class Real>
void add_answer(io::JsonWriter& json, const Hit<Real>& hit, Feature feature);
void add_answer(io::JsonWriter& json, const Crossings& crossings);
template <class Real>
void add_answer(io::JsonWriter& json, const NearestPoint<Real>& nearest);

}  // namespace pierce::tool
