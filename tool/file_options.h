// SPDX-License-Identifier: Apache-2.0
//
// What the commands share that ask a mesh about something and write the answers to a file.
#pragma once

#include <string>

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
  bool quiet = false;
};

/// --out, required; `text` says what is written.
void add_out_option(CLI::App& app, FileOptions& options, const std::string& text);

/// --quiet.
void add_quiet_flag(CLI::App& app, FileOptions& options);

/// --precision, --threads and --quiet.
void add_work_options(CLI::App& app, FileOptions& options);

}  // namespace pierce::tool
