// SPDX-License-Identifier: Apache-2.0
//
// Meshes of 10^5 to 10^6 triangles: deep trees, full stacks, many leaves behind one edge.
#include "campaign/meshes.h"
#include "support/shapes.h"

namespace pierce::campaign {
namespace {

template <class Real>
Mesh<Real> many_copies(Rng& rng, int count) {
  Mesh<Real> mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.triangles.assign(static_cast<std::size_t>(count), {0, 1, 2});
  for (int i = 0; i < count / 1000; ++i) {
    mesh.triangles[rng.below(mesh.triangles.size())] = {1, 2, 3};
    mesh.triangles[rng.below(mesh.triangles.size())] = {0, 4, 2};
  }
  return mesh;
}

template <class Real>
void move(Mesh<Real>& mesh, double scale, double offset) {
  for (auto& v : mesh.vertices) {
    v = finite<Real>(double{v.x} * scale + offset, double{v.y} * scale + 2 * offset,
                     double{v.z} * scale);
  }
}

}  // namespace

template <class Real>
NamedMeshes<Real> large_meshes(Rng& rng) {
  const int count = 100'000 << rng.below(4);
  const int side = static_cast<int>(std::sqrt(count / 2));
  Mesh<Real> mesh;
  std::string name;
  switch (rng.below(7)) {
    case 0:
      name = "large soup";
      mesh = hard::soup<Real>(rng, count, 0.01);
      break;
    case 1:
      name = "large terrain";
      mesh = hard::sheet<Real>(side, side, [&](int, int) { return rng.within(2); });
      break;
    case 2:
      name = "large steps";
      mesh = hard::sheet<Real>(side, side, [&](int, int) { return rng.between(0, 2); });
      break;
    case 3:
      name = "large torus";
      mesh = hard::torus<Real>(static_cast<std::uint32_t>(side), static_cast<std::uint32_t>(side),
                               0.375);
      break;
    case 4:
      name = "large lattice";
      mesh = hard::lattice<Real>(rng, count, {40, 40, 40});
      break;
    case 5:
      name = "many copies";
      mesh = many_copies<Real>(rng, count / 4);
      break;
    default:
      name = "large needles";
      mesh = hard::needles<Real>(rng, count / 2, 1 << 20);
      break;
  }
  if (rng.one_in(4)) move(mesh, std::ldexp(1.0, rng.between(-100, 60)), 0);
  if (rng.one_in(4)) move(mesh, 0.001, 4321234.5);
  return {name, {std::move(mesh)}};
}

template NamedMeshes<float> large_meshes(Rng&);
template NamedMeshes<double> large_meshes(Rng&);

}  // namespace pierce::campaign
