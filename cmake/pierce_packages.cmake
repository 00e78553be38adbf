# SPDX-License-Identifier: Apache-2.0
#
# C++ libraries of the readers, the tool and the tests that must be of the same standard library and
# processor as everything else.
option(PIERCE_INSTALLED_LIBRARIES "Link fmt, Assimp, Draco, meshoptimizer, libzip, Expat, zlib, \
libzstd, CGAL and GoogleTest as installed; OFF, where they are of another standard library or \
processor: fmt as headers, GoogleTest from its source, none of the others (no 3MF, no compressed \
glTF, nothing packed by gzip or zstd)" ON)
set(PIERCE_GOOGLETEST /usr/src/googletest CACHE PATH
  "GoogleTest's source, if PIERCE_INSTALLED_LIBRARIES is OFF (Debian: googletest)")

if(PIERCE_INSTALLED_LIBRARIES)
  set(PIERCE_FMT fmt::fmt)
else()
  set(PIERCE_FMT fmt::fmt-header-only)
endif()

# GTest::gtest_main, either way.
macro(pierce_find_googletest)
  if(PIERCE_INSTALLED_LIBRARIES)
    find_package(GTest REQUIRED)
  elseif(NOT EXISTS ${PIERCE_GOOGLETEST}/googletest/CMakeLists.txt)
    message(FATAL_ERROR "GoogleTest's source is not in ${PIERCE_GOOGLETEST}: install it (Debian: "
      "googletest), or say where it is with -DPIERCE_GOOGLETEST=FOLDER")
  else()
    set(INSTALL_GTEST OFF)
    add_subdirectory(${PIERCE_GOOGLETEST}/googletest ${PROJECT_BINARY_DIR}/googletest
      EXCLUDE_FROM_ALL)
  endif()
endmacro()
