// SPDX-License-Identifier: Apache-2.0
#include "ray_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

#include "bounds.h"
#include "failure.h"
#include "parse.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

MadeRays sized(RayKind kind, const std::string& size, const char* option) {
  const ImageSize parsed = parse_size(size, option);
  MadeRays rays;
  rays.kind = kind;
  rays.width = parsed.width;
  rays.height = parsed.height;
  return rays;
}

MadeRays of_camera(const Camera& camera) {
  MadeRays rays;
  rays.kind = RayKind::Camera;
  rays.width = camera.size.width;
  rays.height = camera.size.height;
  rays.origin = camera.eye;
  rays.forward = camera.forward;
  rays.right = camera.right;
  rays.up = camera.up;
  return rays;
}

double& along_axis(Vec& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// Cells over the sides of the box; rays begin a little outside of it, so that none begins on it.
MadeRays of_grid(const RayOptions& options, const Box& box) {
  MadeRays rays = sized(RayKind::Grid, options.grid, "--grid");
  const bool backward = options.along.starts_with('-');
  const std::string name = options.along.substr(backward || options.along.starts_with('+') ? 1 : 0);
  if (name != "x" && name != "y" && name != "z")
    throw UsageError(fmt::format("--along: '{}' is none of x, y, z, -x, -y, -z", options.along));
  const int axis = name[0] - 'x', across = (axis + 1) % 3, upward = (axis + 2) % 3;
  const Vec half = 0.5 * (box.high - box.low);
  along_axis(rays.forward, axis) = backward ? -1 : 1;
  along_axis(rays.right, across) = component(half, across);
  along_axis(rays.up, upward) = component(half, upward);
  rays.origin = box.centre();
  const double clear = 1.0625 * component(half, axis) + 0x1p-10 * box.diagonal();
  along_axis(rays.origin, axis) += backward ? clear : -clear;
  return rays;
}

MadeRays of_lidar(const RayOptions& options, const Box& box, bool z_up) {
  MadeRays rays = sized(RayKind::Lidar, options.lidar, "--lidar");
  const std::vector<double> range = parse_numbers(options.elevations, 2, "--elevations");
  if (!(std::fabs(range[0]) < 90 && std::fabs(range[1]) < 90 && range[0] <= range[1]))
    throw UsageError("--elevations: give the lowest and the highest, degrees between -90 and 90");
  rays.origin = options.at.empty() ? box.centre() : parse_vector(options.at, "--at");
  const Vec extent = box.high - box.low;
  const bool flat = extent.z < 0.25 * std::min(extent.x, extent.y);
  rays.forward = z_up || flat ? Vec{0, 0, 1} : Vec{0, 1, 0};
  rays.right = {1, 0, 0};
  rays.up = cross(rays.forward, rays.right);
  rays.lowest = std::tan(range[0] / 180 * std::numbers::pi);
  rays.highest = std::tan(range[1] / 180 * std::numbers::pi);
  return rays;
}

MadeRays of_sphere(const RayOptions& options, const Box& box) {
  MadeRays rays;
  rays.kind = RayKind::Sphere;
  rays.width = options.sphere;
  rays.seed = options.seed;
  rays.origin = box.centre();
  rays.forward.x = box.diagonal() > 0 ? box.diagonal() / 2 : 1;
  return rays;
}

}  // namespace

void add_ray_options(CLI::App& app, RayOptions& options) {
  app.add_option("--rays", options.rays,
                 "Rays: .npy or .csv, with columns ox oy oz dx dy dz [t_min t_max]; - is standard "
                 "input");
  CLI::Option* const camera =
      app.add_flag("--camera", options.camera,
                   "Instead of --rays: those of a camera, one a pixel, made as they are cast");
  add_camera_options(app, options.pinhole);
  for (const char* name : {"--size", "--eye", "--look-at", "--up", "--fov"})
    app.get_option(name)->needs(camera);
  CLI::Option* const grid =
      app.add_option("--grid", options.grid,
                     "Instead of --rays: parallel ones, one a cell of a grid over the mesh's box")
          ->type_name("WxH");
  app.add_option("--along", options.along, "With --grid: their direction")
      ->type_name("x|y|z|-x|-y|-z")
      ->default_str("-z")
      ->needs(grid);
  CLI::Option* const lidar =
      app.add_option("--lidar", options.lidar,
                     "Instead of --rays: those of a turning scanner, so many directions a turn, so "
                     "many rings")
          ->type_name("WxH");
  app.add_option("--at", options.at, "With --lidar: where it stands; default: the box's centre")
      ->type_name("X,Y,Z")
      ->needs(lidar);
  app.add_option("--elevations", options.elevations,
                 "With --lidar: of its lowest and its highest ring, in degrees")
      ->type_name("LOW,HIGH")
      ->default_str("-25,15")
      ->needs(lidar);
  CLI::Option* const sphere =
      app.add_option("--sphere", options.sphere,
                     "Instead of --rays: N random chords of the sphere about the mesh's box")
          ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 48).description("N"));
  app.add_option("--seed", options.seed, "With --sphere: other rays for each number")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 53).description("S"))
      ->default_str("1")
      ->needs(sphere);
}

void check_one_source(const RayOptions& options) {
  const int sources = int{!options.rays.empty()} + int{options.camera} +
                      int{!options.grid.empty()} + int{!options.lidar.empty()} +
                      int{options.sphere != 0};
  if (sources > 1)
    throw UsageError("give one of --rays, --camera, --grid, --lidar and --sphere, not several");
}

template <class Real>
MadeRays make_rays(const RayOptions& options, std::span<const MeshView<Real>> meshes, bool z_up) {
  const MadeRays rays = [&] {
    if (options.camera) return of_camera(make_camera<Real>(options.pinhole, meshes, z_up));
    const Box box = box_of(meshes);
    if (!options.grid.empty()) return of_grid(options, box);
    if (!options.lidar.empty()) return of_lidar(options, box, z_up);
    return of_sphere(options, box);
  }();
  return rays;
}

std::uint64_t RayStream::size() const {
  if (const auto* made = std::get_if<MadeRays>(&source_)) return made->count();
  return std::get<io::RayFile>(source_).size();
}

std::string RayStream::name() const {
  if (const auto* made = std::get_if<MadeRays>(&source_))
    return fmt::format("--{}", name_of(made->kind));
  return std::get<io::RayFile>(source_).name();
}

std::vector<std::uint64_t> RayStream::shape() const {
  const auto* made = std::get_if<MadeRays>(&source_);
  if (made == nullptr || made->kind == RayKind::Sphere) return {size()};
  return {made->height, made->width};
}

template <class Real>
void RayStream::read(std::uint64_t first, std::span<Ray<Real>> out) const {
  if (const auto* made = std::get_if<MadeRays>(&source_)) return made->make(first, out);
  std::get<io::RayFile>(source_).read(first, out);
}

template MadeRays make_rays(const RayOptions&, std::span<const MeshView<float>>, bool);
template MadeRays make_rays(const RayOptions&, std::span<const MeshView<double>>, bool);
template void RayStream::read(std::uint64_t, std::span<Ray<float>>) const;
template void RayStream::read(std::uint64_t, std::span<Ray<double>>) const;

}  // namespace pierce::tool
