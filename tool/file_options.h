// SPDX-License-Identifier: Apache-2.0
//
// What the commands share that ask a mesh about something and write the answers to a file.
#pragma once

#include <string>

#include "io/json_writer.h"
#include "io/rays.h"
#include "io/record_target.h"
#include "loaded_scene.h"

namespace CLI {
class App;
}

namespace pierce::tool {

struct FileOptions {
  MeshOptions meshes;
  std::string out;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
  bool quiet = false, json = false;
  std::string format;  ///< of what goes to standard output: npy, csv, or nothing: csv
};

/// --out, required; `text` says what is written.
void add_out_option(CLI::App& app, FileOptions& options, const std::string& text);

/// --quiet.
void add_quiet_flag(CLI::App& app, FileOptions& options);

/// --out and --format for tables of answers. Not required: see answer_target.
void add_answers_option(CLI::App& app, FileOptions& options, const std::string& text);

/// --precision, --threads, --quiet and --json.
void add_work_options(CLI::App& app, FileOptions& options);

/// Where --out and --format say that answers go. Throws UsageError if they say nothing, contradict
/// each other, or want standard output for themselves although --json does, too.
[[nodiscard]] io::RecordTarget answer_target(const FileOptions& options);
/// The check by itself, before anything is read.
void check_answer_options(const FileOptions& options);

/// What a summary calls --out.
[[nodiscard]] std::string out_name(const FileOptions& options);

/// Throws UsageError unless the name of --out ends in .npy, or is "-".
void require_npy(const std::string& out);

/// Whether a table's numbers may be taken as floats: none is rounded silently.
[[nodiscard]] bool counts_as_single(const io::TableFile& file, Precision precision);

/// The object that --json prints, open: what all commands that ask a mesh say first.
template <class Real>
[[nodiscard]] io::JsonWriter begin_json(const char* command, const FileOptions& options,
                                        const LoadedScene<Real>& scene);

/// Adds how often exact arithmetic was needed.
void add_decisions(io::JsonWriter& json, const Statistics& statistics);
void add_roundings(io::JsonWriter& json, const Statistics& statistics);

/// Closes the object and prints it.
void finish_json(io::JsonWriter& json);

extern template io::JsonWriter begin_json(const char*, const FileOptions&,
                                          const LoadedScene<float>&);
extern template io::JsonWriter begin_json(const char*, const FileOptions&,
                                          const LoadedScene<double>&);

}  // namespace pierce::tool
