# AWMR_KERNELS: the vector instruction sets for which the simulation of batches of runs is compiled, one kernel for each
# (lib/awmr/simulate/simd/README.md).
#   avx2, avx512  on x86-64; both by default
#   neon          on 64-bit ARM; by default
#   (empty)       none: runs are simulated one by one
#   native        one kernel that the building processor supports: avx2 (also with AVX-512, because avx2 gives the same bits and
#                 compiles in half the time) or neon; none on x86-64 without AVX2 and fused multiply-add
#   runnable      those of the default that the building processor supports, because the others cannot be tested there
# Sets AWMR_BUILT_KERNELS, the list of kernels to build.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(known_kernels avx2 avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(known_kernels neon)
else()
  set(known_kernels "")
endif()
set(AWMR_KERNELS "${known_kernels}" CACHE STRING
  "Vector instruction sets of batches: a list of ${known_kernels}; native; runnable; empty for none")

if(NOT AWMR_KERNELS MATCHES "^(native|runnable)$")
  set(AWMR_BUILT_KERNELS ${AWMR_KERNELS})
  list(REMOVE_DUPLICATES AWMR_BUILT_KERNELS)
elseif(CMAKE_CROSSCOMPILING)
  message(FATAL_ERROR "AWMR_KERNELS=${AWMR_KERNELS} describes the building processor. Name the target's kernels: ${known_kernels}")
elseif("avx2" IN_LIST known_kernels)
  set(AWMR_BUILT_KERNELS "")
  if(EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo processor_flags REGEX "^flags" LIMIT_COUNT 1)
    if(" ${processor_flags} " MATCHES " avx2 " AND " ${processor_flags} " MATCHES " fma ")
      set(AWMR_BUILT_KERNELS avx2)
      if(AWMR_KERNELS STREQUAL "runnable" AND " ${processor_flags} " MATCHES " avx512f ")
        list(APPEND AWMR_BUILT_KERNELS avx512)
      endif()
    endif()
  endif()
else()
  set(AWMR_BUILT_KERNELS ${known_kernels})
endif()
foreach(kernel IN LISTS AWMR_BUILT_KERNELS)
  if(NOT kernel IN_LIST known_kernels)
    message(FATAL_ERROR "AWMR_KERNELS has '${kernel}'. On ${CMAKE_SYSTEM_PROCESSOR} it takes "
      "'${known_kernels}' or some of these, 'native', 'runnable', or nothing.")
  endif()
endforeach()
