// SPDX-License-Identifier: Apache-2.0
#include "run_tool.h"

#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <new>
#include <string>
#include <vector>

#include "bench_command.h"
#include "command.h"
#include "failure.h"
#include "interrupt.h"
#include "io/output_file.h"
#include "output.h"
#include "pierce/version.h"
#include "suggest.h"

namespace pierce::tool {
namespace {

struct Tool {
  CLI::App app{"Which triangles does a ray pierce? Exactly.", "pierce"};
  std::vector<Command> commands;

  Tool() {
    app.set_version_flag("--version", fmt::format("pierce {}", pierce::kVersion));
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    app.footer(
        "Exit status: 0 done, 1 bad data or a difference found, 2 bad usage.\n"
        "`pierce COMMAND --help` explains a command, with examples.");
    for (auto* add :
         {add_build, add_cast, add_locate, add_voxelise, add_nearest, add_render, add_view,
          add_rays, add_triangle, add_textbook, add_info, add_weld, add_check, add_job}) {
      commands.push_back(add(app));
    }
#ifdef PIERCE_TOOL_BENCH
    commands.push_back(add_bench(app));
#endif
  }
};

// demo.sh, for one, builds without the contenders, for which it would need their packages.
constexpr const char* kNoBench =
    "bench: this command was built without the benchmark; build it with cmake --preset release "
    "-DPIERCE_BUILD_BENCH=ON && cmake --build --preset release (./test.sh installs what that "
    "needs)";

int fail(const std::string& message, int status) {
  std::string line = "pierce: " + message;
  std::replace(line.begin(), line.end(), '\n', ' ');
  remark(line + "\n");
  return status;
}

// "; did you mean 'cast'?" or nothing.
std::string hint(const std::string& typed, const std::vector<std::string>& words) {
  const std::string word = nearest_word(typed, words);
  return word.empty() ? "" : fmt::format("; did you mean '{}'?", word);
}

std::vector<std::string> command_names(const Tool& tool) {
  std::vector<std::string> names;
  for (const Command& command : tool.commands) names.push_back(command.app->get_name());
  return names;
}

const Command* asked_for(const Tool& tool) {
  for (const Command& command : tool.commands) {
    if (command.app->parsed()) return &command;
  }
  return nullptr;
}

// What is wrong with the command line, in one line.
std::string explain(const Tool& tool, const CLI::ParseError& e) {
  const Command* command = asked_for(tool);
  if (command == nullptr) {
    const std::vector<std::string> unknown = tool.app.remaining();
    if (unknown.empty()) return fmt::format("{}; try 'pierce --help'", e.what());
    return fmt::format("'{}' was not expected; try 'pierce --help'", unknown.front());
  }
  const CLI::App* app = command->app;
  std::string name = app->get_name();
  for (; !app->get_subcommands().empty(); name += " " + app->get_name())
    app = app->get_subcommands().front();
  const std::vector<std::string> extra = app->remaining();
  if (extra.empty()) return fmt::format("{}: {}; try 'pierce {} --help'", name, e.what(), name);

  const std::string word = extra.front().substr(0, extra.front().find('='));
  std::vector<std::string> options;
  for (const CLI::Option* option : app->get_options()) {
    options.push_back(option->get_name());
  }
  std::string cure = word.starts_with('-') ? hint(word, options) : "";
  if (cure.empty()) cure = fmt::format("; try 'pierce {} --help'", name);
  return fmt::format("{}: '{}' was not expected{}", name, word, cure);
}

// Values such as "-.5,1,2" or "-inf" look like options; joined to the option before them they do
// not.
std::vector<std::string> joined_values(int argc, char** argv) {
  std::vector<std::string> args;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const bool number = arg.starts_with("-.") || arg.starts_with("-inf") || arg.starts_with("-nan");
    if (number && !args.empty() && args.back().starts_with("--")) {
      args.back() += "=" + arg;
    } else {
      args.push_back(arg);
    }
  }
  return args;
}

int parse_and_run(Tool& tool, std::vector<std::string> args) {
  if (args.empty()) {
    print(tool.app.help());
    return kExitBadUsage;
  }
  const std::vector<std::string> names = command_names(tool);
  if (!args[0].starts_with('-') && std::find(names.begin(), names.end(), args[0]) == names.end()) {
    const std::string cure = hint(args[0], names);
    if (args[0] == "bench") return fail(kNoBench, kExitBadUsage);
    return fail(fmt::format("'{}' is not a command{}", args[0],
                            cure.empty() ? "; try 'pierce --help'" : cure),
                kExitBadUsage);
  }
  try {
    std::reverse(args.begin(), args.end());  // CLI11 takes them from the back
    tool.app.parse(std::move(args));
  } catch (const CLI::CallForVersion& e) {
    print(std::string(e.what()) + "\n");
    return 0;
  } catch (const CLI::CallForHelp&) {
    const Command* command = asked_for(tool);
    print(command == nullptr ? tool.app.help() : command->app->help(tool.app.get_name()));
    return 0;
  } catch (const CLI::ParseError& e) {
    return fail(explain(tool, e), kExitBadUsage);
  }
  const Command& command = *asked_for(tool);
  try {
    return command.run();
  } catch (const UsageError& e) {
    return fail(fmt::format("{}: {}", command.app->get_name(), e.what()), kExitBadUsage);
  }
}

}  // namespace

int run_tool(int argc, char** argv) {
  try {
    Tool tool;
    return parse_and_run(tool, joined_values(argc, argv));
  } catch (const io::BrokenPipe&) {
    interrupt::end_at_once(128 + SIGPIPE);  // as if the signal had not been ignored
  } catch (const Error& e) {
    if (e.code() == ErrorCode::Stopped) return fail("stopped", interrupt::exit_status());
    return fail(e.what(), e.code() == ErrorCode::UnknownKernel ? kExitBadUsage : kExitBadData);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory for these data", kExitBadData);
  } catch (const std::exception& e) {
    return fail(e.what(), kExitBadData);
  }
}

}  // namespace pierce::tool
