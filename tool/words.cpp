// SPDX-License-Identifier: Apache-2.0
#include "words.h"

#include <fmt/format.h>

#include <array>

#include "check/exact.h"
#include "support/count_words.h"

namespace pierce::tool {
namespace {

using Column = std::array<Exact, 3>;

template <class Real>
Column exact(const Vec3<Real>& v) {
  return {Exact(static_cast<double>(v.x)), Exact(static_cast<double>(v.y)),
          Exact(static_cast<double>(v.z))};
}

Column operator-(const Column& a, const Column& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Exact determinant(const Column& a, const Column& b, const Column& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

std::string triangle_name(Feature feature, std::uint32_t triangle, std::uint32_t geometry) {
  return fmt::format("{}triangle {} of geometry {}",
                     feature == Feature::Face ? "" : fmt::format("{} of ", name_of(feature)),
                     triangle, geometry);
}

const char* facing_name(Facing facing) { return facing == Facing::Front ? "front" : "back"; }

}  // namespace

template <class Real>
Feature hit_feature(const Hit<Real>& hit, const Ray<Real>& ray, MeshView<Real> mesh) {
  if (hit.u != 0 && hit.v != 0 && hit.w != 0) return Feature::Face;
  const Triangle& t = mesh.triangles[hit.triangle];
  const Column o = exact(ray.origin), d = exact(ray.direction);
  const Column a = exact(mesh.vertices[t[0]]) - o, b = exact(mesh.vertices[t[1]]) - o,
               c = exact(mesh.vertices[t[2]]) - o;
  // The weight of a corner is 0 where the ray meets the line through the other two.
  const bool no_a = determinant(d, b, c).sign() == 0, no_b = determinant(d, c, a).sign() == 0,
             no_c = determinant(d, a, b).sign() == 0;
  if (no_b && no_c) return Feature::VertexA;
  if (no_c && no_a) return Feature::VertexB;
  if (no_a && no_b) return Feature::VertexC;
  return no_c ? Feature::EdgeAB : no_a ? Feature::EdgeBC : no_b ? Feature::EdgeCA : Feature::Face;
}

const char* name_of(Feature feature) {
  constexpr std::array<const char*, 7> kNames = {"vertex a", "vertex b", "vertex c", "edge ab",
                                                 "edge bc",  "edge ca",  "face"};
  return kNames.at(static_cast<std::size_t>(feature));
}

template <class Real>
std::string to_words(const Hit<Real>& hit, Feature feature) {
  if (hit.triangle == kNone) return "misses";
  return fmt::format("hits {}, {}, at t = {}: u = {}, v = {}, w = {}",
                     triangle_name(feature, hit.triangle, hit.geometry), facing_name(hit.facing),
                     hit.t, hit.u, hit.v, hit.w);
}

std::string to_words(const Crossings& crossings) {
  return fmt::format("{}, signed count {}{}", counted(crossings.count, "passage", "passages"),
                     crossings.signed_count,
                     crossings.origin_on_surface ? "; the origin is on the surface" : "");
}

const char* to_words(Location location) {
  return location == Location::Inside      ? "inside"
         : location == Location::OnSurface ? "on the surface"
                                           : "outside";
}

template <class Real>
std::string to_words(const NearestPoint<Real>& n) {
  if (n.triangle == kNone) return "no surface within the radius";
  return fmt::format("nearest is {},{},{} on {} at distance {}: u = {}, v = {}, w = {}", n.point.x,
                     n.point.y, n.point.z, triangle_name(n.feature, n.triangle, n.geometry),
                     n.distance, n.u, n.v, n.w);
}

template <class Real>
void add_answer(io::JsonWriter& json, const Hit<Real>& hit, Feature feature) {
  json.value("hit", hit.triangle != kNone);
  if (hit.triangle == kNone) return;
  json.value("t", hit.t);
  json.value("u", hit.u);
  json.value("v", hit.v);
  json.value("w", hit.w);
  json.value("geometry", hit.geometry);
  json.value("triangle", hit.triangle);
  json.value("facing", facing_name(hit.facing));
  json.value("feature", name_of(feature));
}

void add_answer(io::JsonWriter& json, const Crossings& crossings) {
  json.value("count", crossings.count);
  json.value("signed_count", crossings.signed_count);
  json.value("origin_on_surface", crossings.origin_on_surface);
}

template <class Real>
void add_answer(io::JsonWriter& json, const NearestPoint<Real>& n) {
  json.value("found", n.triangle != kNone);
  if (n.triangle == kNone) return;
  json.values("point", std::vector{n.point.x, n.point.y, n.point.z});
  json.value("distance", n.distance);
  json.value("u", n.u);
  json.value("v", n.v);
  json.value("w", n.w);
  json.value("geometry", n.geometry);
  json.value("triangle", n.triangle);
  json.value("feature", name_of(n.feature));
}

template Feature hit_feature(const Hit<float>&, const Ray<float>&, MeshView<float>);
template Feature hit_feature(const Hit<double>&, const Ray<double>&, MeshView<double>);
template std::string to_words(const Hit<float>&, Feature);
template std::string to_words(const Hit<double>&, Feature);
template std::string to_words(const NearestPoint<float>&);
template std::string to_words(const NearestPoint<double>&);
template void add_answer(io::JsonWriter&, const Hit<float>&, Feature);
template void add_answer(io::JsonWriter&, const Hit<double>&, Feature);
template void add_answer(io::JsonWriter&, const NearestPoint<float>&);
template void add_answer(io::JsonWriter&, const NearestPoint<double>&);

}  // namespace pierce::tool
