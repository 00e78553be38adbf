// SPDX-License-Identifier: Apache-2.0
#include "check/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace pierce::tool {
namespace {

template <class Real>
std::string hex(Real x) {
  return fmt::format("{:a}", x);
}

template <class Real>
std::string hex(const Vec3<Real>& v) {
  return hex(v.x) + "," + hex(v.y) + "," + hex(v.z);
}

template <class Real>
std::string line_of(const char* who, const Hit<Real>& hit) {
  if (hit.triangle == kNone) return fmt::format("  {} a miss\n", who);
  const std::string geometry =
      hit.geometry == 0 ? "" : fmt::format(" of geometry {}", hit.geometry);
  return fmt::format("  {} triangle {}{} ({}) t {} u {} v {} w {}\n", who, hit.triangle, geometry,
                     hit.facing == Facing::Front ? "front" : "back", hex(hit.t), hex(hit.u),
                     hex(hit.v), hex(hit.w));
}

template <class Real>
void add_lines(std::string& text, const char* who, std::span<const Hit<Real>> hits) {
  constexpr std::size_t kMost = 8;
  if (hits.empty()) text += fmt::format("  {} no hit\n", who);
  for (const Hit<Real>& hit : hits.first(std::min(hits.size(), kMost))) text += line_of(who, hit);
  if (hits.size() > kMost) text += fmt::format("  {} {} more\n", who, hits.size() - kMost);
}

// The first triangle that the two lists do not agree about.
template <class Real>
TriangleRef culprit(std::span<const Hit<Real>> expected, std::span<const Hit<Real>> got) {
  const auto ref = [](const Hit<Real>& hit) { return TriangleRef{hit.geometry, hit.triangle}; };
  std::size_t i = 0;
  while (i < expected.size() && i < got.size() && identical(expected[i], got[i])) ++i;
  if (i < expected.size() && expected[i].triangle != kNone) return ref(expected[i]);
  return i < got.size() ? ref(got[i]) : TriangleRef{};
}

}  // namespace

template <class Real>
bool identical(const Hit<Real>& a, const Hit<Real>& b) {
  const auto same = [](Real x, Real y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return same(a.t, b.t) && same(a.u, b.u) && same(a.v, b.v) && same(a.w, b.w) &&
         a.geometry == b.geometry && a.triangle == b.triangle && a.facing == b.facing;
}

template <class Real>
std::string describe_difference(const std::string& where, std::span<const MeshView<Real>> meshes,
                                const Ray<Real>& ray, std::span<const Hit<Real>> expected,
                                std::span<const Hit<Real>> got) {
  const std::string numbers = fmt::format("{},{},{},{}", hex(ray.origin), hex(ray.direction),
                                          hex(ray.t_min), hex(ray.t_max));
  std::string text = where + "\n  ray      " + numbers + "\n";
  add_lines(text, "expected", expected);
  add_lines(text, "got     ", got);
  const TriangleRef ref = culprit(expected, got);
  if (ref.geometry < meshes.size() && ref.triangle < meshes[ref.geometry].triangles.size()) {
    const MeshView<Real>& mesh = meshes[ref.geometry];
    const Triangle& t = mesh.triangles[ref.triangle];
    text += fmt::format("  see: pierce triangle --triangle={},{},{} --ray={}\n",
                        hex(mesh.vertices[t[0]]), hex(mesh.vertices[t[1]]),
                        hex(mesh.vertices[t[2]]), numbers);
  }
  return text;
}

template bool identical(const Hit<float>&, const Hit<float>&);
template bool identical(const Hit<double>&, const Hit<double>&);
template std::string describe_difference(const std::string&, std::span<const MeshView<float>>,
                                         const Ray<float>&, std::span<const Hit<float>>,
                                         std::span<const Hit<float>>);
template std::string describe_difference(const std::string&, std::span<const MeshView<double>>,
                                         const Ray<double>&, std::span<const Hit<double>>,
                                         std::span<const Hit<double>>);

}  // namespace pierce::tool
