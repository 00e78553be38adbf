// SPDX-License-Identifier: Apache-2.0
//
// The command `pierce`: finds the command that the user asked for, runs it, and turns whatever goes
// wrong into one line and an exit status. Each command has a file of its own.
#pragma once

namespace pierce::tool {

/// The exit status, for the arguments of main.
int run_tool(int argc, char** argv);

}  // namespace pierce::tool
