// SPDX-License-Identifier: Apache-2.0
//
// pierce check: hard rays against the oracle, on meshes from files or made for the purpose.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "check/check_mesh.h"
#include "check/hard_meshes.h"
#include "command.h"
#include "failure.h"
#include "interrupt.h"
#include "io/json_writer.h"
#include "loaded_scene.h"
#include "output.h"
#include "suggest.h"

namespace pierce::tool {
namespace {

struct CheckArguments {
  MeshOptions meshes;
  std::vector<std::string> generate;
  bool suite = false, together = false, json = false;
  Precision precision = Precision::Auto;  // Auto: both
  CheckOptions check;
};

class Report {
 public:
  explicit Report(bool as_json) : as_json_(as_json) {
    json_.open_object();
    json_.value("command", "check");
    json_.open_array("scenes");
    if (as_json) return;
    print(fmt::format("{:<24} {:<6} {:>10} {:>8} {:>9} {:>9} {:>9} {:>7} {:>6}\n", "mesh", "type",
                      "triangles", "rays", "hits", "on edges", "exact", "s", "wrong"));
  }

  template <class Real>
  void check(const std::string& name, std::span<const MeshView<Real>> meshes,
             const CheckOptions& options) {
    const CheckResult r = naming_file(name, [&] {
      const auto scene = Scene<Real>::build(
          meshes, {.work = {.threads = options.threads, .stop = interrupt::stop()}});
      return check_mesh<Real>(name, meshes, scene, options);
    });
    std::uint64_t triangles = 0;
    for (const MeshView<Real>& mesh : meshes) triangles += mesh.triangles.size();
    const char* const type = std::is_same_v<Real, float> ? "float" : "double";
    if (as_json_) {
      add_to_json(name, type, triangles, r);
    } else {
      print(fmt::format("{:<24} {:<6} {:>10} {:>8} {:>9} {:>9} {:>9} {:>7.1f} {:>6}\n",
                        shortened(name), type, triangles, r.rays, r.hits, r.on_edge,
                        exact_decisions(r), r.seconds, r.differences));
      print(r.first);
    }
    differences_ += r.differences;
    checks_ += 1;
    rays_ += r.rays;
  }

  template <class Real>
  void check_one(const std::string& name, MeshView<Real> mesh, const CheckOptions& options) {
    check<Real>(name, {&mesh, 1}, options);
  }

  int finish() {
    if (as_json_) {
      json_.close_array();
      json_.value("rays", rays_);
      json_.value("differences", differences_);
      json_.close_object();
      print(json_.text());
    } else {
      print(fmt::format("{} on {}: {}\n", counted(rays_, "ray", "rays"),
                        counted(checks_, "scene", "scenes"),
                        counted(differences_, "difference", "differences")));
    }
    return differences_ == 0 ? 0 : 1;
  }

 private:
  static std::uint64_t exact_decisions(const CheckResult& r) {
    const Statistics& s = r.statistics;
    return s.settled + s.settled_big + s.orders_settled + s.rounded_exactly + s.rays_placed_exactly;
  }

  void add_to_json(const std::string& name, const char* type, std::uint64_t triangles,
                   const CheckResult& r) {
    json_.open_object();
    json_.value("mesh", name);
    json_.value("precision", type);
    json_.value("triangles", triangles);
    json_.value("rays", r.rays);
    json_.value("hits", r.hits);
    json_.value("on_edges", r.on_edge);
    json_.value("exact", exact_decisions(r));
    json_.value("seconds", r.seconds);
    json_.value("differences", r.differences);
    if (!r.first.empty()) json_.value("first_difference", r.first);
    json_.close_object();
  }

  // The end of a path says more than its beginning.
  static std::string shortened(const std::string& name) {
    constexpr std::size_t kMost = 24;
    return name.size() <= kMost ? name : "..." + name.substr(name.size() - (kMost - 3));
  }

  bool as_json_;
  io::JsonWriter json_;
  std::uint64_t differences_ = 0, rays_ = 0, checks_ = 0;
};

void check_generated(Report& report, const std::string& name, const CheckArguments& options) {
  if (options.precision != Precision::Double) {
    const auto mesh = make_hard_mesh<float>(name);
    report.check_one(name, mesh.view(), options.check);
  }
  if (options.precision != Precision::Float) {
    const auto mesh = make_hard_mesh<double>(name);
    report.check_one(name, mesh.view(), options.check);
  }
}

// Files of doubles may hold numbers that no float can; then only double can be checked.
std::optional<Meshes<float>> as_float(const std::vector<Geometry>& geometries,
                                      const CheckArguments& options) {
  try {
    return Meshes<float>(geometries);
  } catch (const Error& e) {
    if (options.precision == Precision::Float) throw;
    remark(fmt::format("pierce: not checked in float: {}\n", e.what()));
    return std::nullopt;
  }
}

// All of it as one scene.
void check_meshes(Report& report, const MeshOptions& meshes, const CheckArguments& options) {
  std::vector<Geometry> geometries = read_geometries(meshes);
  const std::string name = name_of(meshes.files);
  if (options.precision != Precision::Double) {
    if (const auto loaded = as_float(geometries, options)) {
      report.check<float>(name, loaded->views(), options.check);
    }
  }
  if (options.precision != Precision::Float) {
    const Meshes<double> loaded(std::move(geometries));
    report.check<double>(name, loaded.views(), options.check);
  }
}

// All names are looked at before the first mesh is checked.
std::vector<std::string> generated_names(const CheckArguments& options) {
  std::vector<std::string> known;
  for (const HardMeshKind& kind : hard_mesh_kinds()) known.emplace_back(kind.name);
  if (options.suite) return known;
  for (const std::string& name : options.generate) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_word(name, known);
    throw UsageError(fmt::format(
        "--generate: '{}' is not a mesh that can be made; {}", name,
        near.empty() ? "see 'pierce check --help'" : fmt::format("did you mean '{}'?", near)));
  }
  return options.generate;
}

int run(const CheckArguments& options) {
  const std::vector<std::string> generated = generated_names(options);
  const MeshOptions& meshes = options.meshes;
  if (generated.empty() && meshes.files.empty()) {
    throw UsageError("give a mesh file, --generate NAME or --suite");
  }
  Report report(options.json);
  for (const std::string& name : generated) check_generated(report, name, options);
  if (options.together && !meshes.files.empty()) {
    check_meshes(report, meshes, options);
  } else {
    for (const std::string& file : meshes.files) {
      check_meshes(report, {{file}, meshes.parts}, options);
    }
  }
  return report.finish();
}

std::string footer() {
  std::string text =
      "Examples:\n"
      "  pierce check bunny.obj\n"
      "  pierce check --suite --rays 100000 bunny.obj cube.3ds\n"
      "  pierce check room.ply chair.obj --together\n"
      "  pierce check --generate voxels --generate needles --precision float\n"
      "Without --precision, float and double scenes are checked both. The oracle gives every\n"
      "triangle near a ray to a textbook method over exact fractions. The first difference is\n"
      "printed as hexadecimal floats; the exit status then is 1.\n"
      "The members of --json: command, scenes (an array of mesh precision triangles rays hits\n"
      "on_edges exact seconds differences and, if there is one, first_difference), rays,\n"
      "differences.\n"
      "Meshes that --generate makes:\n";
  for (const HardMeshKind& kind : hard_mesh_kinds()) {
    text += fmt::format("  {:<12} {}\n", kind.name, kind.what);
  }
  text.pop_back();
  return text;
}

}  // namespace

Command add_check(CLI::App& app) {
  CLI::App* sub =
      app.add_subcommand("check", "Cast hard rays at a mesh and compare with exact fractions");
  const auto options = std::make_shared<CheckArguments>();
  sub->add_option("MESH", options->meshes.files,
                  "Mesh files (PLY, STL, OBJ, OFF, glTF, 3DS, ...), each a scene");
  add_reading_flags(*sub, options->meshes);
  sub->add_flag("--together", options->together,
                "All mesh files are one scene, of geometry 0, 1, ...");
  sub->add_option("--generate", options->generate, "Check a mesh made to be hard; see below")
      ->type_name("NAME")
      ->allow_extra_args(false);
  sub->add_flag("--suite", options->suite, "Check all meshes that --generate can make");
  sub->add_option("--rays", options->check.rays, "Rays for each mesh and precision")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40U).description("N"))
      ->capture_default_str();
  sub->add_option("--seed", options->check.seed, "Another number, other rays")
      ->capture_default_str();
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->check.threads);
  sub->add_flag("--json", options->json, "Print one JSON object in place of the table");
  sub->footer(footer());
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
