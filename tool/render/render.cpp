// SPDX-License-Identifier: Apache-2.0
//
// pierce render: a picture of a mesh. Rows are cast in bands, each pixel with several rays.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "failure.h"
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

namespace pierce::tool {
namespace {

struct Options {
  std::string mesh, out;
  Shade shade = Shade::Normal;
  CameraOptions camera;
  Precision precision = Precision::Auto;
  unsigned samples = 4;
  LightOptions light;
  bool smooth = false;
  unsigned threads = 0;
};

constexpr std::size_t kRaysInBand = std::size_t{1} << 20;
constexpr Color kBackgroundTop = {0.955F, 0.96F, 0.965F};
constexpr Color kBackgroundBottom = {0.80F, 0.81F, 0.825F};

// The rays of a band of rows: all samples of a pixel together, pixel by pixel, row by row.
template <class Real>
std::vector<Ray<Real>> band_rays(const Camera& camera, const Options& options, unsigned first,
                                 unsigned end) {
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

template <class Real>
void draw_band(const Scene<Real>& scene, const Shader<Real>& shader, const Camera& camera,
               const Options& options, unsigned first, unsigned end,
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
}

template <class Real>
int render_as(const Options& options, io::Mesh mesh) {
  // Before the long work: wrong options should not take long to say so.
  const LoadedScene<Real> file(options.mesh, std::move(mesh),
                               {.work = {.threads = options.threads}});
  const Camera camera = make_camera(options.camera, file.view(), has_z_up(options.mesh));
  const Surface<Real> surface(file.view(), file.mesh(), options.smooth);
  const std::unique_ptr<Shader<Real>> shader =
      casts_light(options.shade)
          ? make_light_shader(options.shade, surface, camera, file.scene(), options.light)
          : make_plain_shader(options.shade, surface, camera, file.view(), options.mesh);

  const interrupt::Graceful graceful;
  ProgressBar bar("render");
  const ImageSize size = camera.size;
  const auto rows = static_cast<unsigned>(std::clamp<std::size_t>(
      kRaysInBand / (std::size_t{size.width} * options.samples), 1, size.height));
  std::vector<std::uint8_t> picture;
  picture.reserve(std::size_t{3} * size.width * size.height);
  for (unsigned y = 0; y < size.height; y += rows) {
    interrupt::check();
    bar.show(static_cast<double>(y) / size.height);
    draw_band(file.scene(), *shader, camera, options, y, std::min(y + rows, size.height), picture);
  }
  interrupt::check();
  io::write_png(options.out, size.width, size.height, picture);
  return 0;
}

int run(const Options& options) {
  if (!options.out.ends_with(".png")) {
    throw UsageError("--out: '" + options.out + "' must end in .png");
  }
  refuse_to_replace(options.out, {options.mesh});
  io::Mesh mesh = read_triangles(options.mesh);
  return choose_float(options.precision, options.mesh, mesh.single_precision)
             ? render_as<float>(options, std::move(mesh))
             : render_as<double>(options, std::move(mesh));
}

void add_shade_option(CLI::App& sub, Shade& shade) {
  static const std::map<std::string, Shade> names = {
      {"normal", Shade::Normal}, {"depth", Shade::Depth},       {"barycentric", Shade::Barycentric},
      {"uv", Shade::Uv},         {"triangle", Shade::Triangle}, {"facing", Shade::Facing},
      {"ao", Shade::Ao},         {"color", Shade::VertexColor}, {"texcoord", Shade::Texcoord},
      {"clay", Shade::Clay}};
  sub.add_option("--shade", shade,
                 "What the colours show: normal (the file's own if it has any), depth, barycentric "
                 "(w, u, v), uv, triangle (a colour each), facing (front blue, back red), ao "
                 "(ambient occlusion), color and texcoord (the file's), clay (lamp and sky)")
      ->transform(CLI::Transformer(names).description(
          "normal|depth|barycentric|uv|triangle|facing|ao|color|texcoord|clay"))
      ->default_str("normal");
}

}  // namespace

Command add_render(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("render", "Draw a picture of a mesh");
  const auto options = std::make_shared<Options>();
  sub->add_option("MESH", options->mesh, "Mesh file (PLY, STL, OBJ, OFF, glTF, 3DS, ...)")
      ->required();
  sub->add_option("--out", options->out, "Picture: .png, 8 bits a channel")->required();
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
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  sub->footer(
      "Examples:\n"
      "  pierce render bunny.obj --out bunny.png\n"
      "  pierce render bunny.obj --shade clay --smooth --samples 16 --out bunny.png\n"
      "  pierce render part.stl --shade facing --eye 3,-4,2 --up 0,0,1 --size 640x480 --out p.png");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
