// SPDX-License-Identifier: Apache-2.0
//
// pierce rays: the rays of a camera as a file, one a pixel, row by row from the top left: what
// `pierce render` casts with one sample, for `pierce cast` and for other programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/npy.h"
#include "io/output_file.h"
#include "output.h"
#include "render/camera.h"

namespace pierce::tool {
namespace {

struct RaysArguments : FileOptions {
  CameraOptions camera;
};

template <class Real>
int write_rays(const RaysArguments& options, const Meshes<Real>& meshes) {
  static_assert(std::endian::native == std::endian::little, ".npy numbers are written as they are");
  const Camera camera =
      make_camera<Real>(options.camera, meshes.views(), has_z_up(options.meshes.files));
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
  if (!options.quiet) {
    Summary table;
    table.add("rays",
              fmt::format("{} = {}x{}", grouped(shape[0]), camera.size.width, camera.size.height));
    table.add("eye", fmt::format("{},{},{}", camera.eye.x, camera.eye.y, camera.eye.z));
    table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
    table.add("wrote", out_name(options));
    remark(table.text());
  }
  return 0;
}

int run(const RaysArguments& options) {
  require_npy(options.out);
  refuse_to_replace(options.out, inputs(options.meshes));
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  return choose_float(options.precision, meshes)
             ? write_rays(options, Meshes<float>(std::move(meshes)))
             : write_rays(options, Meshes<double>(std::move(meshes)));
}

}  // namespace

Command add_rays(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("rays", "Write the rays of a camera to a file");
  const auto options = std::make_shared<RaysArguments>();
  add_mesh_arguments(*sub, options->meshes);
  add_out_option(*sub, *options,
                 "Rays: .npy with columns ox oy oz dx dy dz, one row a pixel, top row first; - is "
                 "standard output");
  add_camera_options(*sub, options->camera);
  add_precision_option(*sub, options->precision);
  add_quiet_flag(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce rays bunny.obj --size 1024x1024 --out rays.npy\n"
      "  pierce cast bunny.obj --rays rays.npy --out hits.npy\n"
      "  pierce rays bunny.obj --out - | pierce cast bunny.obj --rays - --out hits.npy\n"
      "Directions are not of unit length: t is the distance along the line of sight.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
