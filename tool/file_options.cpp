// SPDX-License-Identifier: Apache-2.0
#include "file_options.h"

#include <CLI/CLI.hpp>

namespace pierce::tool {

void add_out_option(CLI::App& app, FileOptions& options, const std::string& text) {
  app.add_option("--out", options.out, text)->required();
}

void add_quiet_flag(CLI::App& app, FileOptions& options) {
  app.add_flag("--quiet", options.quiet, "Print no summary");
}

void add_work_options(CLI::App& app, FileOptions& options) {
  add_precision_option(app, options.precision);
  add_threads_option(app, options.threads);
  add_quiet_flag(app, options);
}

}  // namespace pierce::tool
