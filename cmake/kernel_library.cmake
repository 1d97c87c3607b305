# add_kernel_library(NAME source...): compiles each source once per instruction set of WAVECREST_ISAS and gathers the
# objects in one static library.
#
# Each compilation sees Highway with exactly one target, so its code lives in that target's own namespace
# (wavecrest::N_AVX3 and so on). The instruction set is switched on by a pragma around our own code
# (HWY_BEFORE_NAMESPACE), never by -m flags: code of the standard library that a kernel file instantiates stays
# baseline x86-64, and the linker may keep any copy of it.
set(WAVECREST_ISA_DEFINES_scalar HWY_COMPILE_ONLY_SCALAR)
set(WAVECREST_ISA_DEFINES_sse4 HWY_COMPILE_ONLY_STATIC HWY_BASELINE_TARGETS=HWY_SSE4)
set(WAVECREST_ISA_DEFINES_avx2 HWY_COMPILE_ONLY_STATIC HWY_BASELINE_TARGETS=HWY_AVX2)
set(WAVECREST_ISA_DEFINES_avx512 HWY_COMPILE_ONLY_STATIC HWY_BASELINE_TARGETS=HWY_AVX3)

# Lane code is made of small structs passed by reference that all end up in registers. Checking each reference for null
# and alignment, and each temporary for its scope, makes a sanitized compilation ten times longer and finds nothing.
# Where they do end up there, sanitized tests run several times as fast, for half as long a compilation again.
# Sanitized lane code has no debug information, as g++ spends long on that of inlined code: the undefined-behaviour
# sanitizer names file and line without it, the address sanitizer only the function.
add_library(wavecrest_lane_options INTERFACE)
target_compile_options(wavecrest_lane_options INTERFACE $<$<CONFIG:Release>:-O3>)  # also where the folder's own are lower
if(WAVECREST_SANITIZE MATCHES "address")
  target_compile_options(wavecrest_lane_options INTERFACE
    -O1 -g0 -fno-sanitize-address-use-after-scope -fno-sanitize=null,alignment,object-size)
endif()

# The scalar twin is what the other instruction sets are compared with; the same source is checked in theirs.
add_library(wavecrest_twin_options INTERFACE)
target_compile_options(wavecrest_twin_options INTERFACE -fno-sanitize=all)

# What each lane source is compiled with.
function(set_lane_options target isa)
  target_compile_definitions(${target} PRIVATE ${WAVECREST_ISA_DEFINES_${isa}})
  target_link_libraries(${target} PRIVATE wavecrest_options wavecrest_lane_options)
  if(WAVECREST_SANITIZE MATCHES "address" AND isa STREQUAL "scalar" AND NOT WAVECREST_ISAS STREQUAL "scalar")
    target_link_libraries(${target} PRIVATE wavecrest_twin_options)
  endif()
endfunction()

# Highway takes g++ longer to read than most lane sources, so it is precompiled once per instruction set.
foreach(isa IN LISTS WAVECREST_ISAS)
  if(NOT DEFINED WAVECREST_ISA_DEFINES_${isa})
    message(FATAL_ERROR "WAVECREST_ISAS: unknown instruction set '${isa}'; known: scalar sse4 avx2 avx512")
  endif()
  add_header_target(wavecrest_lane_headers_${isa}
    <algorithm> <array> <cmath> <cstdint> <hwy/highway.h> <limits> <type_traits>)
  set_lane_options(wavecrest_lane_headers_${isa} ${isa})
endforeach()

# add_lane_sources(NAME source...): object libraries NAME_<instruction set> of lane sources. Those of tests and
# microbenchmarks register their entry points (kernels/simd/isa_table.h).
function(add_lane_sources name)
  foreach(isa IN LISTS WAVECREST_ISAS)
    add_library(${name}_${isa} OBJECT ${ARGN})
    set_lane_options(${name}_${isa} ${isa})
    reuse_precompiled_headers(${name}_${isa} wavecrest_lane_headers_${isa} -Wno-uninitialized)
  endforeach()
endfunction()

function(add_kernel_library name)
  add_library(${name} STATIC)
  add_lane_sources(${name} ${ARGN})
  foreach(isa IN LISTS WAVECREST_ISAS)
    set_target_properties(${name}_${isa} PROPERTIES UNITY_BUILD OFF)  # the long ones are to be built in parallel
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:${name}_${isa}>)
  endforeach()
endfunction()

# add_lane_executable(NAME SOURCES source... LANE_SOURCES source... LANES name... LIBRARIES library...): an executable of
# plain sources, of lane sources of its own and of those that several share. For tests and microbenchmarks.
function(add_lane_executable name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "SOURCES;LANE_SOURCES;LANES;LIBRARIES")
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE wavecrest_options wavecrest_isa ${ARG_LIBRARIES})
  if(ARG_LANE_SOURCES)
    add_lane_sources(${name} ${ARG_LANE_SOURCES})
    list(APPEND ARG_LANES ${name})
  endif()
  foreach(lanes IN LISTS ARG_LANES)
    foreach(isa IN LISTS WAVECREST_ISAS)
      target_sources(${name} PRIVATE $<TARGET_OBJECTS:${lanes}_${isa}>)
    endforeach()
  endforeach()
endfunction()
