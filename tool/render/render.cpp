// SPDX-License-Identifier: Apache-2.0
//
// pierce render: a picture of a mesh. Rows are cast in bands, each pixel with several rays.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "choice.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/png.h"
#include "loaded_scene.h"
#include "output.h"
#include "progress_bar.h"
#include "render/camera.h"
#include "render/color.h"
#include "render/sampling.h"
#include "render/shade.h"
#include "render/surface.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

struct RenderArguments : FileOptions {
  Shade shade = Shade::Normal;
  CameraOptions camera;
  unsigned samples = 4;
  LightOptions light;
  bool smooth = false;
};

constexpr std::size_t kRaysInBand = std::size_t{1} << 20;
constexpr Color kBackgroundTop = {0.955F, 0.96F, 0.965F};
constexpr Color kBackgroundBottom = {0.80F, 0.81F, 0.825F};

// The rays of a band of rows: all samples of a pixel together, pixel by pixel, row by row.
template <class Real>
std::vector<Ray<Real>> band_rays(const Camera& camera, const RenderArguments& options,
                                 unsigned first, unsigned end) {
  std::vector<Ray<Real>> rays;
  rays.reserve(std::size_t{end - first} * camera.size.width * options.samples);
  for (unsigned y = first; y < end; ++y) {
    for (unsigned x = 0; x < camera.size.width; ++x) {
      const std::uint64_t pixel = std::uint64_t{y} * camera.size.width + x;
      for (unsigned s = 0; s < options.samples; ++s) {
        const Point2 at = options.samples == 1 ? Point2{0.5, 0.5}
                                               : spread_point(s, options.light.seed ^ pixel << 1U);
        rays.push_back(camera.ray<Real>(x + at.x, y + at.y));
      }
    }
  }
  return rays;
}

void put_pixel(std::vector<std::uint8_t>& picture, const Color& color) {
  for (const float part : {color.x, color.y, color.z}) {
    picture.push_back(static_cast<std::uint8_t>(
        std::lround(255.0F * std::clamp(std::isnan(part) ? 0.0F : part, 0.0F, 1.0F))));
  }
}

// Returns how many of the camera's rays hit something.
template <class Real>
std::uint64_t draw_band(const Scene<Real>& scene, const Shader<Real>& shader, const Camera& camera,
                        const RenderArguments& options, unsigned first, unsigned end,
                        std::vector<std::uint8_t>& picture) {
  BatchOptions batch;
  batch.work.threads = options.threads;
  batch.work.stop = interrupt::stop();
  const std::vector<Ray<Real>> rays = band_rays<Real>(camera, options, first, end);
  std::vector<Hit<Real>> hits(rays.size());
  scene.closest_hits(rays, hits, batch);

  std::vector<Color> colors(rays.size());
  const std::size_t row = std::size_t{camera.size.width} * options.samples;
  for (unsigned y = first; y < end; ++y) {
    const float k = (static_cast<float>(y) + 0.5F) / static_cast<float>(camera.size.height);
    std::fill_n(colors.begin() + static_cast<std::ptrdiff_t>((y - first) * row), row,
                blend(kBackgroundTop, kBackgroundBottom, k));
  }
  const std::uint64_t number = std::uint64_t{first} * row;
  shader.shade(rays, hits, number, batch, colors);

  for (std::size_t i = 0; i < colors.size(); i += options.samples) {
    Color sum = {0, 0, 0};
    for (unsigned s = 0; s < options.samples; ++s) sum = sum + colors[i + s];
    put_pixel(picture, 1 / static_cast<float>(options.samples) * sum);
  }
  return static_cast<std::uint64_t>(std::count_if(
      hits.begin(), hits.end(), [](const auto& hit) { return hit.triangle != kNone; }));
}

template <class Real>
void summarise(const RenderArguments& options, const LoadedScene<Real>& scene,
               const ImageSize& size, std::uint64_t hits, double render_seconds) {
  const std::uint64_t rays = std::uint64_t{size.width} * size.height * options.samples;
  Summary table;
  scene.add_size_to(table);
  table.add("picture", fmt::format("{}x{}, {} a pixel", size.width, size.height,
                                   counted(options.samples, "ray", "rays")));
  table.add("hits", fmt::format("{} ({})", grouped(hits), percentage(hits, rays)));
  scene.add_to(table);
  table.add("render", timing(render_seconds, rays, "rays of the camera"));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
int render_as(const RenderArguments& options, std::vector<Geometry> meshes) {
  // Before the long work: wrong options should not take long to say so.
  const LoadedScene<Real> loaded(std::move(meshes), {.work = {.threads = options.threads}});
  const Camera camera = make_camera(options.camera, loaded.views(), has_z_up(options.meshes.files));
  const Surface<Real> surface(loaded.meshes(), options.smooth);
  const std::unique_ptr<Shader<Real>> shader =
      casts_light(options.shade)
          ? make_light_shader(options.shade, surface, camera, loaded.scene(), options.light)
          : make_plain_shader(options.shade, surface, camera, loaded.views(),
                              name_of(options.meshes.files));

  const interrupt::Graceful graceful;
  const Stopwatch watch;
  ProgressBar bar("render");
  const ImageSize size = camera.size;
  const auto rows = static_cast<unsigned>(std::clamp<std::size_t>(
      kRaysInBand / (std::size_t{size.width} * options.samples), 1, size.height));
  std::vector<std::uint8_t> picture;
  picture.reserve(std::size_t{3} * size.width * size.height);
  std::uint64_t hits = 0;
  for (unsigned y = 0; y < size.height; y += rows) {
    interrupt::check();
    bar.show(static_cast<double>(y) / size.height);
    hits += draw_band(loaded.scene(), *shader, camera, options, y, std::min(y + rows, size.height),
                      picture);
  }
  interrupt::check();
  io::write_png(options.out, size.width, size.height, picture);
  if (!options.quiet) summarise(options, loaded, size, hits, watch.seconds());
  return 0;
}

int run(const RenderArguments& options) {
  check_extension(options.out, {".png"});
  refuse_to_replace(options.out, inputs(options.meshes));
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  return choose_float(options.precision, meshes) ? render_as<float>(options, std::move(meshes))
                                                 : render_as<double>(options, std::move(meshes));
}

void add_shade_option(CLI::App& sub, Shade& shade) {
  add_choice<Shade>(
      sub, "--shade", shade,
      {{"normal", Shade::Normal},
       {"depth", Shade::Depth},
       {"barycentric", Shade::Barycentric},
       {"uv", Shade::Uv},
       {"triangle", Shade::Triangle},
       {"facing", Shade::Facing},
       {"ao", Shade::Ao},
       {"color", Shade::VertexColor},
       {"texcoord", Shade::Texcoord},
       {"clay", Shade::Clay}},
      "What the colours show: normal (the file's own if it has any), depth, barycentric "
      "(w, u, v), uv, triangle (a colour each), facing (front blue, back red), ao "
      "(ambient occlusion), color and texcoord (the file's), clay (lamp and sky)");
}

}  // namespace

Command add_render(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("render", "Draw a picture of a mesh");
  const auto options = std::make_shared<RenderArguments>();
  add_mesh_arguments(*sub, options->meshes);
  add_out_option(*sub, *options, "Picture: .png, 8 bits a channel");
  add_shade_option(*sub, options->shade);
  add_camera_options(*sub, options->camera);
  sub->add_option("--samples", options->samples, "Rays a pixel; 1 is through its centre")
      ->check(CLI::Range(1U, 4096U).description("N"))
      ->default_str("4");
  sub->add_option("--light-samples", options->light.samples,
                  "ao and clay: rays into the surroundings from each hit")
      ->check(CLI::Range(1U, 65536U).description("N"))
      ->default_str("16");
  sub->add_option("--seed", options->light.seed, "Another number, another noise")->default_str("0");
  sub->add_flag("--smooth", options->smooth, "Make normals where the file has none");
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce render bunny.obj --out bunny.png\n"
      "  pierce render bunny.obj --shade clay --smooth --samples 16 --out bunny.png\n"
      "  pierce render part.stl --shade facing --eye 3,-4,2 --up 0,0,1 --size 640x480 --out p.png");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
