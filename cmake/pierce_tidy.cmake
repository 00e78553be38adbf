# SPDX-License-Identifier: Apache-2.0
#
# ninja tidy: clang-tidy (.clang-tidy) over the library, the readers and the tool.
find_program(PIERCE_CLANG_TIDY NAMES run-clang-tidy run-clang-tidy-14)
if(PIERCE_CLANG_TIDY AND PIERCE_COMPILE_TOGETHER)
  add_custom_target(tidy
    COMMAND ${CMAKE_COMMAND} -E echo "tidy: configure with -DPIERCE_COMPILE_TOGETHER=OFF"
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
elseif(PIERCE_CLANG_TIDY)
  add_custom_target(tidy
    COMMAND ${PIERCE_CLANG_TIDY} -quiet -p ${PROJECT_BINARY_DIR}
      "${PROJECT_SOURCE_DIR}/(src|tool)/.*[.]cpp$"
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} USES_TERMINAL VERBATIM)
endif()
