# SPDX-License-Identifier: Apache-2.0
#
# PIERCE_THIRD_PARTY: whether Boost, Highway, fmt, fast_float, CLI11, nlohmann_json and stb are this
# machine's or those in third_party/ (docs/decisions/0025-third-party.md).
set(PIERCE_THIRD_PARTY_CHOICES none missing all)
set(PIERCE_THIRD_PARTY none CACHE STRING "Which libraries are taken from third_party/: none, all \
are installed; those that are missing; all of them")
set_property(CACHE PIERCE_THIRD_PARTY PROPERTY STRINGS ${PIERCE_THIRD_PARTY_CHOICES})
if(NOT PIERCE_THIRD_PARTY IN_LIST PIERCE_THIRD_PARTY_CHOICES)
  list(JOIN PIERCE_THIRD_PARTY_CHOICES ", " choices)
  message(FATAL_ERROR "PIERCE_THIRD_PARTY is '${PIERCE_THIRD_PARTY}': give one of ${choices}")
endif()

# Makes the target, Library::part, of third_party/Library.
function(pierce_make_third_party target)
  string(REGEX REPLACE "::.*" "" library ${target})
  set(folder ${PROJECT_SOURCE_DIR}/third_party/${library})
  string(REPLACE "::" "_" name "third_party_${target}")
  file(GLOB sources ${folder}/${library}/*.cc)
  if(sources)
    add_library(${name} STATIC ${sources})
    target_include_directories(${name} PRIVATE ${folder})
  else()
    add_library(${name} INTERFACE)
  endif()
  target_include_directories(${name} SYSTEM INTERFACE $<BUILD_INTERFACE:${folder}>)
  if(library STREQUAL Boost)
    target_compile_definitions(${name} INTERFACE BOOST_MP_STANDALONE)
  elseif(library STREQUAL fmt)
    target_compile_definitions(${name} INTERFACE FMT_HEADER_ONLY)
  elseif(library STREQUAL hwy AND PIERCE_INSTALL)
    message(FATAL_ERROR "Highway of third_party/ serves the Python package and programs that are "
      "built with pierce: it cannot be installed. Set -DPIERCE_INSTALL=OFF, or install Highway "
      "(Debian: libhwy-dev)")
  endif()
  add_library(${target} ALIAS ${name})
  message(STATUS "${library}: third_party/${library}")
endfunction()

# pierce_find(PACKAGE TARGET): the target, from the installed package or from third_party/.
macro(pierce_find package target)
  if(PIERCE_THIRD_PARTY STREQUAL none)
    find_package(${package} REQUIRED)
  elseif(PIERCE_THIRD_PARTY STREQUAL missing)
    find_package(${package} QUIET)
  endif()
  if(NOT TARGET ${target})
    pierce_make_third_party(${target})
  endif()
endmacro()
