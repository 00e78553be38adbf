# SPDX-License-Identifier: Apache-2.0
#
# Whoever runs `pip install .` is told at once, and in one piece, what is missing and how to get it.
find_program(PIERCE_PKG_CONFIG NAMES pkg-config pkgconf)
find_path(PIERCE_STB stb/stb_image_write.h)
find_path(PIERCE_JSON nlohmann/json.hpp)
set(missing "")
foreach(library Boost hwy fmt FastFloat CLI11)
  find_package(${library} QUIET)
  if(NOT ${library}_FOUND)
    list(APPEND missing ${library})
  endif()
endforeach()
if(NOT PIERCE_STB)
  list(APPEND missing stb)
endif()
if(NOT PIERCE_JSON)
  list(APPEND missing nlohmann_json)
endif()
if(NOT PIERCE_PKG_CONFIG)
  list(APPEND missing pkg-config)
endif()
if(missing)
  list(JOIN missing ", " missing)
  message(FATAL_ERROR "Not found, but needed to compile pierce: ${missing}. Debian and Ubuntu: "
    "apt-get install pkg-config libboost-dev libhwy-dev libfmt-dev libfast-float-dev libcli11-dev "
    "libstb-dev nlohmann-json3-dev")
endif()
