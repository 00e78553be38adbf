// SPDX-License-Identifier: Apache-2.0
//
// The list of meshes, and what all of them need.
#include "workloads/mesh.h"

#include <algorithm>

#include "io/read_mesh.h"
#include "pierce/error.h"
#include "workloads/generators.h"
#include "workloads/names.h"

namespace pierce::bench {

const std::vector<MeshKind>& mesh_kinds() {
  static const std::vector<MeshKind> kinds{
      {"bunny", "the Stanford bunny of Debian's glmark2-data, 70 k triangles", true, make_bunny},
      {"city", "40,000 boxes on a ground, 480 k triangles", true, make_city},
      {"needles", "25,000 long thin tetrahedra in all directions, 100 k triangles", true,
       make_needles},
      {"hall", "a building of bars, pipes, cables and stairs with ornaments, 410 k triangles", true,
       make_hall},
      {"stadium", "the bunny amid 16,000 seats, 454 k triangles", true, make_stadium},
      {"bunny-fine", "the bunny divided by 16, with jitter, 1.1 M triangles", true,
       make_fine_bunny},
      {"terrain", "hills, a grid of 2000 x 2000, 8 M triangles", true, make_terrain},
      {"terrain-50m", "hills, a grid of 5000 x 5000, 50 M triangles", false, make_big_terrain},
  };
  return kinds;
}

Mesh make_mesh(const std::string& name) {
  for (const MeshKind& kind : mesh_kinds()) {
    if (kind.name == name) {
      Mesh mesh = kind.make();
      mesh.name = name;
      return mesh;
    }
  }
  throw Error(ErrorCode::InvalidArgument,
              "there is no benchmark mesh '" + name + "'; there are: " + names_of(mesh_kinds()));
}

Mesh load_mesh(const std::filesystem::path& path) {
  const io::Mesh file = io::read_mesh(path);
  if (file.triangles.empty())
    throw Error(ErrorCode::BadFile, path.string() + ": no triangles, nothing to measure");
  Mesh mesh;
  mesh.name = path.filename().string();
  mesh.vertices = io::to_float(file.vertices);
  mesh.triangles = file.triangles;
  finish(mesh, kPortrait);
  return mesh;
}

void finish(Mesh& mesh, const Framing& framing) {
  mesh.vertices.reserve(mesh.vertices.size() + 1);
  Vec3<float> lower = mesh.vertices.front();
  Vec3<float> upper = lower;
  for (const Vec3<float>& p : mesh.vertices) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  mesh.box = {to_double(lower), to_double(upper)};
  const Double3 center = mesh.box.center();
  const double radius = mesh.box.radius();
  const double distance = framing.filled * radius / mesh.view.half_height;
  mesh.view.eye = center + distance * normalized(framing.direction);
  mesh.view.look_at = center;
  mesh.view.up = framing.up;
  const Double3 aside = normalized(cross(framing.up, framing.direction));
  const Double3 to_light = 0.5 * normalized(framing.direction) + framing.light_height * framing.up;
  mesh.view.light = center + (2.5 * radius) * normalized(aside + to_light);
}

}  // namespace pierce::bench
