# SPDX-License-Identifier: Apache-2.0
#
# cmake --install: headers, library, find_package(pierce), pkg-config pierce, the tool.
include(CMakePackageConfigHelpers)

set_target_properties(pierce PROPERTIES
  VERSION ${PROJECT_VERSION}
  # Before 1.0 a minor version may change the ABI.
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  EXPORT_NAME pierce)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/pierce DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
install(TARGETS pierce EXPORT pierce_targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET pierce_tool)
  install(TARGETS pierce_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET pierce_c)
  set_target_properties(pierce_c PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  install(TARGETS pierce_c EXPORT pierce_targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# find_package(pierce). A static pierce must name what it was built with, a shared one need not.
get_target_property(pierce_type pierce TYPE)
set(pierce_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pierce)
set(PIERCE_PC_REQUIRES "libhwy")
set(PIERCE_PC_LIBS "")
set(PIERCE_FIND_DEPENDENCIES "find_dependency(hwy)")
if(PIERCE_PARALLEL STREQUAL tbb)
  string(PREPEND PIERCE_PC_REQUIRES "tbb ")
  string(PREPEND PIERCE_FIND_DEPENDENCIES "find_dependency(TBB)\n")
elseif(PIERCE_PARALLEL STREQUAL threads)
  set(PIERCE_PC_LIBS " ${CMAKE_THREAD_LIBS_INIT}")
  string(PREPEND PIERCE_FIND_DEPENDENCIES
    "set(THREADS_PREFER_PTHREAD_FLAG ON)\nfind_dependency(Threads)\n")
endif()
if(pierce_type STREQUAL "STATIC_LIBRARY")
  string(PREPEND PIERCE_PC_REQUIRES "Requires: ")
else()
  set(PIERCE_FIND_DEPENDENCIES "")
  set(PIERCE_PC_LIBS "")
  string(PREPEND PIERCE_PC_REQUIRES "Requires.private: ")
endif()
install(EXPORT pierce_targets NAMESPACE pierce:: DESTINATION ${pierce_cmake_dir}
  FILE pierceTargets.cmake)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pierceConfig.cmake.in
  ${PROJECT_BINARY_DIR}/pierceConfig.cmake INSTALL_DESTINATION ${pierce_cmake_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pierceConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pierceConfig.cmake
  ${PROJECT_BINARY_DIR}/pierceConfigVersion.cmake DESTINATION ${pierce_cmake_dir})

# pkg-config: the prefix is found from where the file lies, so an installed tree can be moved.
file(RELATIVE_PATH PIERCE_PC_PREFIX
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/pierce.pc.in ${PROJECT_BINARY_DIR}/pierce.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pierce.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(TARGET pierce_c)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/pierce_c.pc.in ${PROJECT_BINARY_DIR}/pierce_c.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/pierce_c.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
