// SPDX-License-Identifier: Apache-2.0
//
// pierce render: a picture of a mesh. Rows are cast in bands, each pixel with several rays.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "choice.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/png.h"
#include "io/rays.h"
#include "io/view_page.h"
#include "loaded_scene.h"
#include "output.h"
#include "parse.h"
#include "progress_bar.h"
#include "render/camera.h"
#include "render/marks.h"
#include "render/picture.h"
#include "render/section.h"
#include "render/shade.h"
#include "render/surface.h"
#include "shown_rays.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

struct RenderArguments : FileOptions {
  Shade shade = Shade::Normal;
  CameraOptions camera;
  PictureOptions picture;
  LightOptions light;
  std::string section, rays, hits;
  bool smooth = false;
};

constexpr std::size_t kRaysInBand = std::size_t{1} << 20;

std::optional<Section> parse_section(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::vector<double> numbers = parse_numbers(text, 4, "--section");
  const Section section{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  if (section.normal == Vec3<double>{0, 0, 0})
    throw UsageError("--section: the normal must not be zero");
  return section;
}

template <class Real>
void summarise(const RenderArguments& options, const LoadedScene<Real>& scene,
               const ImageSize& size, std::uint64_t hits, double render_seconds) {
  const std::uint64_t rays = std::uint64_t{size.width} * size.height * options.picture.samples;
  Summary table;
  scene.add_size_to(table);
  table.add("picture", fmt::format("{}x{}, {} a pixel", size.width, size.height,
                                   counted(options.picture.samples, "ray", "rays")));
  table.add("hits", fmt::format("{} ({})", grouped(hits), percentage(hits, rays)));
  scene.add_to(table);
  table.add("render", timing(render_seconds, rays, "rays of the camera"));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
int render_as(const RenderArguments& options, std::vector<Geometry> meshes,
              const std::optional<io::RayFile>& file) {
  // Before the long work: wrong options should not take long to say so.
  const LoadedScene<Real> loaded(std::move(meshes), {.work = {.threads = options.threads}});
  const Camera camera = make_camera(options.camera, loaded.views(), has_z_up(options.meshes.files));
  const Surface<Real> surface(loaded.meshes(), options.smooth);
  const std::unique_ptr<Shader<Real>> shader =
      casts_light(options.shade)
          ? make_light_shader(options.shade, surface, camera, loaded.scene(), options.light)
          : make_plain_shader(options.shade, surface, camera, loaded.views(),
                              name_of(options.meshes.files));

  const std::vector<Ray<Real>> rays = read_shown_rays<Real>(file);
  std::vector<io::ViewHit<Real>> shown;
  if (!options.hits.empty()) {
    shown = read_shown_hits<Real>(options.hits);
    naming_file(options.hits, [&] { io::check_hits<Real>(shown, loaded.views()); });
  } else if (file) {
    shown = first_hits<Real>(options.rays, loaded.scene(), rays, options.threads);
  }
  const Marks<Real> marks(camera, loaded.views(), rays, shown);
  const Picture<Real> picture(options.picture, camera, loaded.scene(), surface, *shader, marks);

  const interrupt::Graceful graceful;
  const Stopwatch watch;
  ProgressBar bar("render");
  BatchOptions batch;
  batch.work.threads = options.threads;
  batch.work.stop = interrupt::stop();
  const ImageSize size = camera.size;
  const auto rows = static_cast<unsigned>(std::clamp<std::size_t>(
      kRaysInBand / (std::size_t{size.width} * options.picture.samples), 1, size.height));
  const unsigned channels = options.picture.channels();
  std::vector<std::uint8_t> bytes;
  bytes.reserve(std::size_t{channels} * size.width * size.height);
  std::uint64_t hits = 0;
  for (unsigned y = 0; y < size.height; y += rows) {
    interrupt::check();
    bar.show(static_cast<double>(y) / size.height);
    hits += picture.draw(y, std::min(y + rows, size.height), batch, bytes);
  }
  interrupt::check();
  io::write_png(options.out, size.width, size.height, bytes, channels);
  if (!options.quiet) summarise(options, loaded, size, hits, watch.seconds());
  return 0;
}

int run(RenderArguments options) {
  check_extension(options.out, {".png"});
  refuse_to_replace(options.out, inputs(options.meshes, {options.rays, options.hits}));
  options.picture.section = options.light.section = parse_section(options.section);
  options.picture.seed = options.light.seed;
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  const std::optional<io::RayFile> rays = open_shown_rays(options.rays);
  const bool single = !rays || counts_as_single(*rays, options.precision);
  return choose_float(options.precision, meshes, options.rays, single)
             ? render_as<float>(options, std::move(meshes), rays)
             : render_as<double>(options, std::move(meshes), rays);
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
  sub->add_flag("--orthographic", options->camera.orthographic,
                "Parallel rays; with --eye as large as a pinhole shows what is looked at");
  sub->add_flag("--edges", options->picture.edges, "Draw the triangles' edges");
  sub->add_flag("--ground", options->picture.ground,
                "The shadow on the ground, which is as low as the mesh");
  add_choice<Background>(*sub, "--background", options->picture.background,
                         {{"gradient", Background::Gradient},
                          {"white", Background::White},
                          {"transparent", Background::Transparent}},
                         "What is behind the mesh");
  sub->add_option(
         "--section", options->section,
         "Cut off what lies where NX x + NY y + NZ z > D; of a closed mesh whose fronts are "
         "outside the inside is filled")
      ->type_name("NX,NY,NZ,D");
  sub->add_option("--rays", options->rays, "Rays to draw in: .npy or .csv, as for cast");
  sub->add_option("--hits", options->hits,
                  "Hits to draw in, as cast wrote them (closest or all); default: the first hit of "
                  "each ray");
  sub->add_option("--samples", options->picture.samples, "Rays a pixel; 1 is through its centre")
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
      "  pierce render bunny.obj --edges --ground --background white --out bunny.png\n"
      "  pierce render bunny.obj --rays rays.npy --orthographic --out rays.png\n"
      "  pierce render part.stl --section 0,0,1,2.5 --shade clay --out cut.png\n"
      "  pierce render part.stl --shade facing --eye 3,-4,2 --up 0,0,1 --size 640x480 --out p.png");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
