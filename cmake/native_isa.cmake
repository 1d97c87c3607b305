# -DWAVECREST_ISAS=native becomes the widest instruction set of this machine that kernels are compiled for
# (kernels/simd/isa.h).
if(NOT WAVECREST_ISAS STREQUAL "native")
  return()
endif()

file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
string(APPEND flags " ")
# Sets `out` if the processor has all flags.
function(machine_has out)
  foreach(flag IN LISTS ARGN)
    if(NOT flags MATCHES " ${flag} ")
      return()
    endif()
  endforeach()
  set(${out} TRUE PARENT_SCOPE)
endfunction()

machine_has(has_avx512 avx512f avx512bw avx512cd avx512dq avx512vl avx2 fma bmi2 f16c)
machine_has(has_avx2 avx2 fma bmi1 bmi2 f16c)
machine_has(has_sse4 sse4_1 sse4_2 pclmulqdq aes)
set(WAVECREST_ISAS scalar)
foreach(isa IN ITEMS sse4 avx2 avx512)
  if(has_${isa})
    set(WAVECREST_ISAS ${isa})
  endif()
endforeach()
message(STATUS "Kernels for this machine alone: ${WAVECREST_ISAS}")
