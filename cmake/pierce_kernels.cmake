# SPDX-License-Identifier: Apache-2.0
#
# Instruction sets.
#
# PIERCE_OTHER_KERNELS: the kernels that this machine runs, but for the best one, which runs anyway.
# Read from /proc/cpuinfo; should it name a kernel that Highway does not find at run time, the tests
# on that kernel fail and say so.
function(pierce_find_kernels result)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)")  # beside NEON
    set(${result} plain PARENT_SCOPE)
    return()
  endif()
  set(kernels plain)
  set(cpu_flags "")
  if(EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo cpu_flags REGEX "^flags" LIMIT_COUNT 1)
  endif()
  set(needs_sse4 sse4_2 aes pclmulqdq)
  set(needs_avx2 avx2 fma bmi1 bmi2 f16c)
  set(needs_avx512 avx512f avx512vl avx512dq avx512bw avx512cd)
  foreach(kernel sse4 avx2 avx512)
    set(missing "")
    foreach(flag IN LISTS needs_${kernel})
      if(NOT "${cpu_flags} " MATCHES " ${flag} ")
        list(APPEND missing ${flag})
      endif()
    endforeach()
    if(NOT missing)
      list(PREPEND kernels ${kernel})
    endif()
  endforeach()
  list(POP_FRONT kernels)
  set(${result} ${kernels} PARENT_SCOPE)
endfunction()

pierce_find_kernels(PIERCE_OTHER_KERNELS)

# PIERCE_KERNEL_OPTIONS: how what includes Highway is compiled. For it NEON and AES are one set, and
# g++ inlines a function only into functions of the same set. No instruction of AES comes of it.
set(PIERCE_KERNEL_OPTIONS "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)" AND CMAKE_CXX_COMPILER_ID STREQUAL GNU
    AND NOT CMAKE_CXX_FLAGS MATCHES "-m(arch|cpu)=")
  set(PIERCE_KERNEL_OPTIONS -march=armv8-a+crypto)
endif()
