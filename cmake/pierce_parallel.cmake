# SPDX-License-Identifier: Apache-2.0
#
# PIERCE_PARALLEL: what src/support/parallel.h is made of. A choice that cannot be had is an error,
# never another choice.
set(PIERCE_PARALLEL_CHOICES tbb threads serial)
set(PIERCE_PARALLEL tbb CACHE STRING
  "Parallel work by oneTBB (tbb), by threads of pierce's own (threads), or none (serial)")
set_property(CACHE PIERCE_PARALLEL PROPERTY STRINGS ${PIERCE_PARALLEL_CHOICES})

if(NOT PIERCE_PARALLEL IN_LIST PIERCE_PARALLEL_CHOICES)
  list(JOIN PIERCE_PARALLEL_CHOICES ", " choices)
  message(FATAL_ERROR "PIERCE_PARALLEL is '${PIERCE_PARALLEL}': give one of ${choices}")
endif()

# PIERCE_PARALLEL_LIBRARY: what to link; the interface pierce_parallel: for whoever includes
# support/parallel.h.
set(PIERCE_PARALLEL_LIBRARY "")
if(PIERCE_PARALLEL STREQUAL tbb)
  find_package(TBB QUIET)
  if(NOT TARGET TBB::tbb)
    message(FATAL_ERROR "oneTBB was not found: install it (Debian: libtbb-dev), or build with "
      "-DPIERCE_PARALLEL=threads, which needs nothing")
  endif()
  if(PIERCE_SANITIZE MATCHES thread)
    message(FATAL_ERROR "The thread sanitizer cannot see into oneTBB and takes every hand-over of "
      "a task for a race: build with -DPIERCE_PARALLEL=threads")
  endif()
  set(PIERCE_PARALLEL_LIBRARY TBB::tbb)
elseif(PIERCE_PARALLEL STREQUAL threads)
  set(THREADS_PREFER_PTHREAD_FLAG ON)
  find_package(Threads REQUIRED)
  set(PIERCE_PARALLEL_LIBRARY Threads::Threads)
endif()
string(TOUPPER ${PIERCE_PARALLEL} parallel)
add_library(pierce_parallel INTERFACE)
target_compile_definitions(pierce_parallel INTERFACE PIERCE_PARALLEL_${parallel})
target_link_libraries(pierce_parallel INTERFACE ${PIERCE_PARALLEL_LIBRARY})
