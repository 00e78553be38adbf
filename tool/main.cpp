// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"
#include "output.h"
#include "run_tool.h"

int main(int argc, char** argv) {
  pierce::tool::reserve_standard_streams();
  pierce::tool::interrupt::install();
  return pierce::tool::run_tool(argc, argv);
}
