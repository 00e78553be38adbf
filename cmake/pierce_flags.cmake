# SPDX-License-Identifier: Apache-2.0
#
# Flags for every target of this project, never exported to its users.
#
# -ffp-contract=off: the error analysis counts every rounding; fused ones are written as fma().
# -fno-semantic-interposition: position-independent code (for shared libraries and bindings) is
#   inlined as freely as any other.
# -fno-tree-slp-vectorize (g++): g++ 12 takes a pair of doubles that are rounded to float and back
#   for a pair that is not rounded at all (tests/unit/compiler_test.cpp).
add_library(pierce_flags INTERFACE)
target_compile_options(pierce_flags INTERFACE
  -Wall -Wextra -Wconversion -Wdouble-promotion -Wfloat-conversion -Wshadow
  $<$<BOOL:${PIERCE_WARNINGS_AS_ERRORS}>:-Werror>
  -ffp-contract=off -fno-fast-math -fno-semantic-interposition
  $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Tests: the same, less two warnings that clang gives where g++ is silent: of an exact double{float}
# and of an int that counts to three. The library, the readers and the tool do without them.
add_library(pierce_test_flags INTERFACE)
target_compile_options(pierce_test_flags INTERFACE
  $<TARGET_PROPERTY:pierce_flags,INTERFACE_COMPILE_OPTIONS>
  $<$<CXX_COMPILER_ID:Clang>:-Wno-double-promotion>
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)

# Sanitizers must reach every object and every link, so they are not left to the targets.
if(PIERCE_SANITIZE)
  add_compile_options(-fsanitize=${PIERCE_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${PIERCE_SANITIZE})
  # What a sanitizer adds hides from g++ that a value is set (Boost's optional).
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
