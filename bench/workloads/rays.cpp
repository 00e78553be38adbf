// SPDX-License-Identifier: Apache-2.0
//
// How each ray set is made. Deterministic, from fixed seeds and the exact hits of the camera.
#include "workloads/rays.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "pierce/error.h"
#include "workloads/names.h"
#include "workloads/prng.h"

namespace pierce::bench {
namespace {

// The even bits of a Morton number: its x; shifted right by one first: its y.
unsigned even_bits(std::uint64_t morton) {
  unsigned out = 0;
  for (unsigned bit = 0; bit < 16; ++bit)
    out |= static_cast<unsigned>((morton >> (2 * bit)) & 1U) << bit;
  return out;
}

// A point on one of the six sides of the box, the sides taken by area.
Double3 point_on_box(const Box& box, Prng& random) {
  const Double3 size = box.upper - box.lower;
  const std::array<double, 3> area{size.y * size.z, size.z * size.x, size.x * size.y};
  double pick = random.unit() * (area[0] + area[1] + area[2]);
  int axis = 0;
  while (axis < 2 && pick >= area[static_cast<std::size_t>(axis)])
    pick -= area[static_cast<std::size_t>(axis++)];
  Double3 p{random.between(box.lower.x, box.upper.x), random.between(box.lower.y, box.upper.y),
            random.between(box.lower.z, box.upper.z)};
  const Double3& end = random.unit() < 0.5 ? box.lower : box.upper;
  (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = component(end, axis);
  return p;
}

}  // namespace

const std::vector<RayKind>& ray_kinds() {
  static const std::vector<RayKind> kinds{
      {"primary", "a camera's rays, in tiles of tiles (Morton order)", true},
      {"rows", "the same rays, row by row", false},
      {"shadow", "from what the camera sees to a light, t_max at the light", true},
      {"bounce", "from what the camera sees, cosine distributed around the normal", true},
      {"random", "chords between random points on the sides of a box around the mesh", true},
  };
  return kinds;
}

RaySet thinned(const RaySet& set, std::size_t most) {
  if (set.rays.size() <= most) return set;
  RaySet few{set.name, {}, {}};
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t place = thinned_place(i, most, set.rays.size());
    few.rays.push_back(set.rays[place]);
    few.rays_double.push_back(set.rays_double[place]);
  }
  return few;
}

RayMaker::RayMaker(const Mesh& mesh, Caster caster, unsigned side)
    : mesh_(mesh), caster_(std::move(caster)), side_(side) {}

RaySet RayMaker::make(const std::string& name) {
  RaySet set{name, {}, {}};
  if (name == "primary") {
    set.rays = camera(false, 0);
  } else if (name == "rows") {
    set.rays = camera(true, 0);
  } else if (name == "random") {
    set.rays = chords();
  } else if (name == "shadow") {
    const Double3 light = mesh_.view.light;
    for (const Surface& s : surface())
      set.rays.push_back({to_float(s.point), to_float(light - s.point), 0, 1});
  } else if (name == "bounce") {
    Prng random(0xb0);
    for (const Surface& s : surface()) {
      // A point of the sphere that touches the surface from outside: cosine distributed.
      const Double3 direction = s.normal + 0.999 * random.on_sphere();
      set.rays.push_back({to_float(s.point), to_float(normalized(direction))});
    }
  } else {
    throw Error(ErrorCode::InvalidArgument,
                "there is no ray set '" + name + "'; there are: " + names_of(ray_kinds()));
  }
  set.rays_double.reserve(set.rays.size());
  for (const Ray<float>& ray : set.rays)
    set.rays_double.push_back({to_double(ray.origin), to_double(ray.direction),
                               static_cast<double>(ray.t_min), static_cast<double>(ray.t_max)});
  return set;
}

// Pass 0 goes through the middles of the pixels, every other through random places in them.
std::vector<Ray<float>> RayMaker::camera(bool by_rows, unsigned pass) const {
  const View& view = mesh_.view;
  const Double3 forward = normalized(view.look_at - view.eye);
  const Double3 right = normalized(cross(forward, view.up));
  const Double3 up = cross(right, forward);
  const Vec3<float> eye = to_float(view.eye);
  const double pixel = 2 * view.half_height / side_;
  Prng random(0xca + pass);
  std::vector<Ray<float>> rays;
  rays.reserve(count());
  for (std::uint64_t i = 0; i < count(); ++i) {
    const unsigned column = by_rows ? static_cast<unsigned>(i % side_) : even_bits(i);
    const unsigned row = by_rows ? static_cast<unsigned>(i / side_) : even_bits(i >> 1);
    const double dx = pass == 0 ? 0.5 : random.unit();
    const double dy = pass == 0 ? 0.5 : random.unit();
    const double x = (column + dx) * pixel - view.half_height;
    const double y = view.half_height - (row + dy) * pixel;
    rays.push_back({eye, to_float(normalized(forward + x * right + y * up))});
  }
  return rays;
}

// The box is a little larger than the mesh's, so that no ray begins in a flat side of the mesh.
std::vector<Ray<float>> RayMaker::chords() const {
  const Double3 size = mesh_.box.upper - mesh_.box.lower;
  const double rim = 0.01 * std::max({size.x, size.y, size.z});
  const Box box{mesh_.box.lower - Double3{rim, rim, rim}, mesh_.box.upper + Double3{rim, rim, rim}};
  Prng random(0xc0);
  std::vector<Ray<float>> rays;
  rays.reserve(count());
  while (rays.size() < count()) {
    const Vec3<float> from = to_float(point_on_box(box, random));
    const Vec3<float> to = to_float(point_on_box(box, random));
    const Double3 direction = to_double(to) - to_double(from);
    if (length(direction) > 1e-3 * mesh_.box.radius())
      rays.push_back({from, to_float(normalized(direction))});
  }
  return rays;
}

const std::vector<RayMaker::Surface>& RayMaker::surface() {
  constexpr unsigned kMostPasses = 200;
  std::vector<Hit<float>> hits(count());
  for (unsigned pass = 0; surface_.size() < count(); ++pass) {
    if (pass == kMostPasses)
      throw Error(ErrorCode::InvalidArgument, "the camera hardly sees " + mesh_.name +
                                                  ": no shadow and bounce rays; choose "
                                                  "--sets primary,random");
    const std::vector<Ray<float>> rays = camera(false, pass);
    caster_(rays, hits);
    for (std::size_t i = 0; i < rays.size() && surface_.size() < count(); ++i)
      if (hits[i].triangle != kNone) surface_.push_back(surface_at(rays[i], hits[i]));
  }
  return surface_;
}

RayMaker::Surface RayMaker::surface_at(const Ray<float>& ray, const Hit<float>& hit) const {
  const Triangle& triangle = mesh_.triangles[hit.triangle];
  const Double3 a = to_double(mesh_.vertices[triangle[0]]);
  const Double3 b = to_double(mesh_.vertices[triangle[1]]);
  const Double3 c = to_double(mesh_.vertices[triangle[2]]);
  Double3 normal = normalized(cross(b - a, c - a));
  const Double3 direction = to_double(ray.direction);
  if (dot(normal, direction) > 0) normal = -1.0 * normal;
  const Double3 point = to_double(ray.origin) + static_cast<double>(hit.t) * direction;
  return {point + (1e-5 * mesh_.box.radius()) * normal, normal};
}

}  // namespace pierce::bench
