// SPDX-License-Identifier: Apache-2.0
//
// pierce rays: the rays of a camera as a file, one a pixel, row by row from the top left: what
// `pierce render` casts with one sample, for `pierce cast` and for other programs.
#include <CLI/CLI.hpp>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "camera.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/npy.h"
#include "io/output_file.h"
#include "output.h"
#include "scene_file.h"

namespace pierce::tool {
namespace {

struct Options {
  std::string mesh, out;
  CameraOptions camera;
  Precision precision = Precision::Auto;
};

template <class Real>
int write_rays(const Options& options, const io::Mesh& mesh, std::vector<Vec3<Real>> vertices) {
  static_assert(std::endian::native == std::endian::little, ".npy numbers are written as they are");
  const Camera camera =
      make_camera<Real>(options.camera, {vertices, mesh.triangles}, has_z_up(options.mesh));
  const interrupt::Graceful graceful;
  io::OutputFile file(options.out);
  const std::uint64_t shape[] = {std::uint64_t{camera.size.width} * camera.size.height, 6};
  file.write(io::make_npy_header(std::is_same_v<Real, float> ? "'<f4'" : "'<f8'", shape));

  std::vector<std::array<Real, 6>> row(camera.size.width);
  for (unsigned y = 0; y < camera.size.height; ++y) {
    interrupt::check();
    for (unsigned x = 0; x < camera.size.width; ++x) {
      const Ray<Real> ray = camera.ray<Real>(x + 0.5, y + 0.5);
      const auto& [o, d] = std::pair(ray.origin, ray.direction);
      row[x] = {o.x, o.y, o.z, d.x, d.y, d.z};
    }
    file.write({reinterpret_cast<const char*>(row.data()), row.size() * sizeof(row[0])});
  }
  file.commit();
  return 0;
}

int run(const Options& options) {
  require_npy(options.out);
  refuse_to_replace(options.out, {options.mesh});
  io::Mesh mesh = read_triangles(options.mesh);
  if (!choose_float(options.precision, options.mesh, mesh.single_precision)) {
    return write_rays<double>(options, mesh, std::move(mesh.vertices));
  }
  return write_rays<float>(options, mesh,
                           naming_file(options.mesh, [&] { return io::to_float(mesh.vertices); }));
}

}  // namespace

Command add_rays(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("rays", "Write the rays of a camera to a file");
  const auto options = std::make_shared<Options>();
  sub->add_option("MESH", options->mesh, "Mesh file, for the camera to look at")->required();
  sub->add_option("--out", options->out,
                  "Rays: .npy with columns ox oy oz dx dy dz, one row a pixel, top row first; - is "
                  "standard output")
      ->required();
  add_camera_options(*sub, options->camera);
  add_precision_option(*sub, options->precision);
  sub->footer(
      "Examples:\n"
      "  pierce rays bunny.obj --size 1024x1024 --out rays.npy\n"
      "  pierce cast bunny.obj --rays rays.npy --out hits.npy\n"
      "  pierce rays bunny.obj --out - | pierce cast bunny.obj --rays - --out hits.npy\n"
      "Directions are not of unit length: t is the distance along the line of sight.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
