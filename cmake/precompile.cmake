# precompile_headers(NAME header...): an object library that holds nothing but these headers, read once. Targets compiled
# with the same options share them by reuse_headers(TARGET NAME). Headers of others only: CMake marks what it
# precompiles as a system header, which would silence the warnings of ours.
#
# Not through ccache, which does not cache a compilation that reads a precompiled header. There each file reads its own
# includes and no others, so that a missing one shows.
set(precompile_by_default ON)
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(precompile_by_default OFF)
endif()
option(WAVECREST_PRECOMPILE "read the headers of Highway and GoogleTest once for all files" ${precompile_by_default})

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/no_code.cpp CONTENT "// Precompiled headers need a source.\n")

function(precompile_headers name)
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/generated/no_code.cpp)
  target_link_libraries(${name} PRIVATE wavecrest_options)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

function(reuse_headers target name)
  if(WAVECREST_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()
