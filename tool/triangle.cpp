// SPDX-License-Identifier: Apache-2.0
//
// pierce triangle: one ray, one triangle, every textbook method beside the exact answer.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>
#include <string>

#include "command.h"
#include "io/output_file.h"
#include "output.h"
#include "parse.h"
#include "textbook/report.h"
#include "textbook/steps.h"

namespace pierce::tool {
namespace {

struct TriangleArguments {
  std::string triangle, ray, steps, svg;
};

int run(const TriangleArguments& options) {
  const TriangleQuestion question = triangle_question(parse_list(options.triangle, "--triangle"),
                                                      parse_list(options.ray, "--ray"));
  std::ostringstream text;
  run_triangle(question, text);
  if (!options.steps.empty()) run_steps(options.steps, question, text);
  if (!options.svg.empty()) {
    io::OutputFile out(options.svg);
    out.write(triangle_picture(question));
    out.commit();
    if (options.svg == "-") return 0;  // standard output is the picture
  }
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
  sub->add_option("--steps", options->steps,
                  "Every value on the way of this method, in float, in double and exactly, and the "
                  "test that rejects: " +
                      fmt::format("{}", fmt::join(kStepMethods, ", ")))
      ->type_name("METHOD");
  sub->add_option("--svg", options->svg, "Drawing of both: .svg; - is standard output, instead");
  sub->footer(
      "Examples:\n"
      "  pierce triangle --triangle 0,0,0,1,0,0,0,1,0 --ray 0.25,0.25,1,0,0,-1\n"
      "  pierce triangle --triangle 0,0,0,1,0,0,0,1,0 --ray 0x1p-2,0,1,0,0,-1,0,inf\n"
      "  pierce triangle --triangle 0,0,0,1,0,0,0,1,0 --ray 1/3,1/3,1,0,0,-1 \\\n"
      "      --steps moller_trumbore --svg picture.svg\n"
      "Numbers are decimal, hexadecimal (0x1.8p-3) or fractions (1/3), each read to the nearest "
      "double.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
