# SPDX-License-Identifier: Apache-2.0
#
# Flags for every target of this project, never exported to its users.
# -ffp-contract=off: the error analysis counts every rounding; fused ones are written as fma().
add_library(pierce_flags INTERFACE)
target_compile_options(pierce_flags INTERFACE
  -Wall -Wextra -Wconversion -Wdouble-promotion -Wfloat-conversion -Wshadow -Werror
  -ffp-contract=off -fno-fast-math)
