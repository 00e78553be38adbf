# SPDX-License-Identifier: Apache-2.0
#
# What makes the tests' programs compile in less time where PIERCE_COMPILE_TOGETHER is on; every
# other tree has each of them by itself, without a precompiled header, optimised as the library is.
set(PIERCE_TEST_HEADERS <gtest/gtest.h> <algorithm> <array> <atomic> <bit> <chrono> <cmath>
  <cstdint> <cstring> <filesystem> <fstream> <functional> <iostream> <limits> <optional> <random>
  <span> <sstream> <string> <string_view> <thread> <utility> <vector> <gmpxx.h>
  <pierce/scene.h>)

# pierce_has_library_code(RESULT SOURCE): whether the source, or a header of tests/ that it
# includes, includes the library's own headers or public ones that compute, whose code is then
# compiled into the test; or whether it is about the compiler.
function(pierce_has_library_code result source)
  if(source MATCHES "/compiler_test[.]cpp$")
    set(${result} ON PARENT_SCOPE)
    return()
  endif()
  set(files ${source})
  set(seen ${source})
  while(files)
    list(POP_FRONT files file)
    file(STRINGS ${file} lines REGEX "^#include \"")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" name "${line}")
      set(header ${PROJECT_SOURCE_DIR}/tests/${name})
      if(NOT EXISTS ${header})
        if(NOT name MATCHES "^(pierce|io)/" OR name MATCHES "^pierce/(barycentric|shapes|textbook)")
          set(${result} ON PARENT_SCOPE)
          return()
        endif()
      elseif(NOT header IN_LIST seen)
        list(APPEND files ${header})
        list(APPEND seen ${header})
      endif()
    endforeach()
  endwhile()
  set(${result} OFF PARENT_SCOPE)
endfunction()

# pierce_quick_test(TARGET SOURCE): such a test has the precompiled header, and -Og if the library
# that it asks is all in the library's own objects.
function(pierce_quick_test target source)
  if(NOT PIERCE_COMPILE_TOGETHER)
    return()
  endif()
  set(first pierce_first_test)
  pierce_has_library_code(as_library ${source})
  if(NOT as_library)
    target_compile_options(${target} PRIVATE -Og)
    set(first pierce_first_quick_test)
  endif()
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    return()
  endif()
  target_compile_options(${target} PRIVATE -fpch-preprocess)  # ccache asks for it
  get_property(owner GLOBAL PROPERTY ${first})
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${PIERCE_TEST_HEADERS})
    set_property(GLOBAL PROPERTY ${first} ${target})
  endif()
endfunction()
