# SPDX-License-Identifier: Apache-2.0
#
# PIERCE_OTHER_KERNELS: the kernels that this machine runs, but for the best one, which runs anyway.
# Read from /proc/cpuinfo; should it name a kernel that Highway does not find at run time, the tests
# on that kernel fail and say so.
function(pierce_find_kernels result)
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
