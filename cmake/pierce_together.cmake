# SPDX-License-Identifier: Apache-2.0
#
# PIERCE_COMPILE_TOGETHER: several sources in one run of the compiler, for builds from nothing
# (test.sh, demo.sh, pip): headers are read once for all of them. Off, for who changes one source
# at a time, and so that every source is also compiled by itself somewhere.
option(PIERCE_COMPILE_TOGETHER "Compile several sources in one run: quicker from nothing" OFF)

# pierce_compile_together(TARGET BATCH [APART]): so many sources of the target a run, but those
# whose path matches the regular expression APART.
function(pierce_compile_together target batch)
  if(NOT PIERCE_COMPILE_TOGETHER)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)  # to g++ an included .cpp is a header
  if(ARGC GREATER 2)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "${ARGV2}")
    set_source_files_properties(${sources} TARGET_DIRECTORY ${target}
      PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()
