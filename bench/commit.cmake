# SPDX-License-Identifier: Apache-2.0
#
# Run at every build: writes the commit into a header, and touches it only when it has changed.
execute_process(COMMAND git describe --always --dirty --abbrev=10
  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "// SPDX-License-Identifier: Apache-2.0
#pragma once
#define PIERCE_COMMIT \"${commit}\"
")
