# SPDX-License-Identifier: Apache-2.0
#
# In a thread-sanitizer build TBB::tbb is tests/tsan/stand_in.h: see there for the reason.
set(pierce_tsan_headers ${PROJECT_BINARY_DIR}/tsan_headers)
foreach(name blocked_range global_control parallel_for parallel_invoke parallel_reduce
    parallel_sort partitioner task_arena)
  file(CONFIGURE OUTPUT ${pierce_tsan_headers}/tbb/${name}.h
    CONTENT "#include \"${PROJECT_SOURCE_DIR}/tests/tsan/stand_in.h\"\n")
endforeach()
add_library(pierce_tsan_tbb INTERFACE)
target_include_directories(pierce_tsan_tbb INTERFACE ${pierce_tsan_headers})
add_library(TBB::tbb ALIAS pierce_tsan_tbb)
