// SPDX-License-Identifier: Apache-2.0
//
// pierce build: meshes made into a scene file, which every command takes in place of them.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "choice.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "loaded_scene.h"
#include "output.h"
#include "progress_bar.h"
#include "save_scene.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

struct BuildArguments : FileOptions {
  Quality quality = Quality::Balanced;
};

template <class Real>
int build_as(const BuildArguments& options, std::vector<Geometry> meshes) {
  const LoadedScene<Real> loaded(
      std::move(meshes), {.quality = options.quality, .work = {.threads = options.threads}});
  const Stopwatch watch;
  save_scene(loaded, options.out, options.threads);
  const double saving = watch.seconds();
  const SceneFileInfo info = scene_file_info(options.out);
  if (options.json) {
    io::JsonWriter json = begin_json("build", options, loaded);
    json.value("seconds", saving);
    json.value("bytes", info.bytes);
    json.value("fingerprint", fingerprint_text(info.fingerprint));
    json.value("out", options.out);
    finish_json(json);
  } else if (!options.quiet) {
    Summary table;
    loaded.add_size_to(table);
    loaded.add_to(table);
    table.add("save", seconds(saving));
    table.add("fingerprint", fingerprint_text(info.fingerprint));
    table.add("wrote", options.out + ", " + memory(info.bytes));
    remark(table.text());
  }
  return 0;
}

int run(const BuildArguments& options) {
  check_extension(options.out, {".pierce"});
  refuse_to_replace(options.out, inputs(options.meshes));
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  return choose_float(options.precision, meshes) ? build_as<float>(options, std::move(meshes))
                                                 : build_as<double>(options, std::move(meshes));
}

}  // namespace

Command add_build(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("build", "Make meshes into a scene file");
  const auto options = std::make_shared<BuildArguments>();
  add_mesh_arguments(*sub, options->meshes);
  add_out_option(*sub, *options, "The scene file, .pierce");
  add_choice<Quality>(*sub, "--quality", options->quality,
                      {{"fast", Quality::Fast},
                       {"balanced", Quality::Balanced},
                       {"high", Quality::High},
                       {"compact", Quality::Compact}},
                      "fast: built quickest; high: asked quickest; compact: least memory");
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce build city.ply --out city.pierce\n"
      "  pierce cast city.pierce --rays rays.npy --out hits.npy\n"
      "  pierce build house.obj --parts --quality high --out house.pierce\n"
      "Every command that takes meshes takes a scene file in their place; it is opened in\n"
      "milliseconds, whatever its size, shared by all processes that have it open, and the same "
      "on\n"
      "every machine. `pierce info FILE --verify` looks at every byte of it. Colours, normals and\n"
      "texture coordinates are not kept.\n"
      "The members of --json: command mesh meshes geometries triangles precision build_seconds\n"
      "seconds bytes fingerprint out.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
