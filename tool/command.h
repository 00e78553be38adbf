// SPDX-License-Identifier: Apache-2.0
//
// A command of the tool: its place on the command line and what it does. One file a command; main
// only dispatches.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace pierce::tool {

struct Command {
  CLI::App* app;             ///< parsed: the user asked for this command
  std::function<int()> run;  ///< returns the exit status; throws UsageError or Error
};

Command add_build(CLI::App& app);
Command add_cast(CLI::App& app);
Command add_check(CLI::App& app);
Command add_info(CLI::App& app);
Command add_job(CLI::App& app);
Command add_locate(CLI::App& app);
Command add_nearest(CLI::App& app);
Command add_rays(CLI::App& app);
Command add_render(CLI::App& app);
Command add_textbook(CLI::App& app);
Command add_triangle(CLI::App& app);
Command add_view(CLI::App& app);
Command add_voxelise(CLI::App& app);
Command add_weld(CLI::App& app);

}  // namespace pierce::tool
