// SPDX-License-Identifier: Apache-2.0
#include "file_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <type_traits>

#include "choice.h"
#include "failure.h"
#include "io/extension.h"

namespace pierce::tool {

void add_out_option(CLI::App& app, FileOptions& options, const std::string& text) {
  app.add_option("--out", options.out, text)->required();
}

void add_quiet_flag(CLI::App& app, FileOptions& options) {
  app.add_flag("--quiet", options.quiet, "Print no summary");
}

void add_answers_option(CLI::App& app, FileOptions& options, const std::string& text) {
  app.add_option("--out", options.out, text);
  add_choice<std::string>(app, "--format", options.format, {{"npy", "npy"}, {"csv", "csv"}},
                          "With --out -: what standard output gets, csv if not told otherwise");
}

void add_work_options(CLI::App& app, FileOptions& options) {
  add_precision_option(app, options.precision);
  add_threads_option(app, options.threads);
  add_quiet_flag(app, options);
  app.add_flag("--json", options.json,
               "Print the summary to standard output, as one JSON object; numbers that are not "
               "finite are null");
}

void check_answer_options(const FileOptions& options) {
  if (options.out.empty()) {
    throw UsageError(
        "--out: name a file for the answers (.npy, .npz or .csv), or - for standard "
        "output");
  }
  if (options.out == "-" && options.json) {
    throw UsageError("--json: standard output gets the answers already; name a file with --out");
  }
  if (options.out == "-") return;
  if (!options.format.empty()) {
    throw UsageError("--format: is for --out -; the name of a file says its format");
  }
  check_extension(options.out, {".npy", ".npz", ".csv"});
}

io::RecordTarget answer_target(const FileOptions& options) {
  check_answer_options(options);
  if (options.out != "-") return {std::filesystem::path(options.out)};
  return {options.out, options.format == "npy" ? io::RecordFormat::Npy : io::RecordFormat::Csv};
}

std::string out_name(const FileOptions& options) {
  return options.out == "-" ? "standard output" : options.out;
}

void require_npy(const std::string& out) {
  if (out == "-" || io::has_extension(out, ".npy")) return;
  throw UsageError("--out: '" + out + "' must end in .npy, or be - for standard output");
}

bool counts_as_single(const io::TableFile& file, Precision precision) {
  // With --precision float integers that are no floats are refused when they are read.
  return file.single_precision() || (precision == Precision::Float && file.whole_numbers());
}

template <class Real>
io::JsonWriter begin_json(const char* command, const FileOptions& options,
                          const LoadedScene<Real>& scene) {
  io::JsonWriter json;
  json.open_object();
  json.value("command", command);
  json.value("mesh", name_of(options.meshes.files));
  add_meshes(json, options.meshes.files);
  json.value("geometries", scene.meshes().size());
  json.value("triangles", scene.meshes().triangles());
  json.value("precision", std::is_same_v<Real, float> ? "float" : "double");
  json.value("build_seconds", scene.build_seconds());
  return json;
}

void add_decisions(io::JsonWriter& json, const Statistics& s) {
  const std::uint64_t exact = s.settled + s.settled_big + s.orders_settled;
  json.value("decisions", exact + s.certified + s.orders_certified);
  json.value("decisions_exact", exact);
}

void add_roundings(io::JsonWriter& json, const Statistics& s) {
  json.value("roundings", s.hits);
  json.value("roundings_exact", s.rounded_exactly);
}

void finish_json(io::JsonWriter& json) {
  json.close_object();
  print(json.text());
}

template io::JsonWriter begin_json(const char*, const FileOptions&, const LoadedScene<float>&);
template io::JsonWriter begin_json(const char*, const FileOptions&, const LoadedScene<double>&);

}  // namespace pierce::tool
