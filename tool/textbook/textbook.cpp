// SPDX-License-Identifier: Apache-2.0
//
// pierce textbook: every textbook method on easy and hard rays.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <sstream>

#include "command.h"
#include "output.h"
#include "textbook/report.h"

namespace pierce::tool {
namespace {

struct TextbookArguments {
  std::uint64_t rays = 20000;
  std::uint64_t seed = 1;
};

int run(const TextbookArguments& options) {
  std::ostringstream text;
  run_textbook(options.rays, options.seed, text);
  print(text.str());
  return 0;
}

}  // namespace

Command add_textbook(CLI::App& app) {
  CLI::App* sub = app.add_subcommand(
      "textbook", "Every textbook method on easy and hard rays: speed and wrong decisions");
  const auto options = std::make_shared<TextbookArguments>();
  sub->add_option("--rays", options->rays, "Pairs of a ray and a triangle, of each sort")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40U).description("N"))
      ->capture_default_str();
  sub->add_option("--seed", options->seed, "Another number, other rays")->capture_default_str();
  sub->footer(
      "Examples:\n"
      "  pierce textbook\n"
      "  pierce textbook --rays 1000000 --seed 7\n"
      "Prints ns a test, wrong decisions and errors in ulp, in float and in double.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
