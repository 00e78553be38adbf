# SPDX-License-Identifier: Apache-2.0
#
# stb::stb, for #include <stb/stb_image_write.h>; stb has no package of CMake's.
find_path(stb_FOLDER stb/stb_image_write.h)
mark_as_advanced(stb_FOLDER)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(stb REQUIRED_VARS stb_FOLDER)
if(stb_FOUND AND NOT TARGET stb::stb)
  add_library(stb::stb INTERFACE IMPORTED)
  target_include_directories(stb::stb SYSTEM INTERFACE ${stb_FOLDER})
endif()
