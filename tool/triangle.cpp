// SPDX-License-Identifier: Apache-2.0
//
// pierce triangle: one ray, one triangle, every textbook method beside the exact answer.
#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>
#include <string>

#include "command.h"
#include "output.h"
#include "parse.h"
#include "textbook/report.h"

namespace pierce::tool {
namespace {

struct TriangleArguments {
  std::string triangle, ray;
};

int run(const TriangleArguments& options) {
  std::ostringstream text;
  run_triangle(triangle_question(parse_list(options.triangle, "--triangle"),
                                 parse_list(options.ray, "--ray")),
               text);
  print(text.str());
  return 0;
}

}  // namespace

Command add_triangle(CLI::App& app) {
  CLI::App* sub =
      app.add_subcommand("triangle", "One ray, one triangle: every method and the exact answer");
  const auto options = std::make_shared<TriangleArguments>();
  sub->add_option("--triangle", options->triangle, "Corners ax,ay,az,bx,by,bz,cx,cy,cz")
      ->required();
  sub->add_option("--ray", options->ray,
                  "Origin, direction and perhaps a range: ox,oy,oz,dx,dy,dz[,t_min,t_max]")
      ->required();
  sub->footer(
      "Examples:\n"
      "  pierce triangle --triangle 0,0,0,1,0,0,0,1,0 --ray 0.25,0.25,1,0,0,-1\n"
      "  pierce triangle --triangle 0,0,0,1,0,0,0,1,0 --ray 0x1p-2,0,1,0,0,-1,0,inf\n"
      "Numbers are decimal or hexadecimal (0x1.8p-3), each read to the nearest double.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
