# Headers that most files of some folders read, parsed once: <gtest/gtest.h> and <nlohmann/json.hpp> take g++ longer than
# what most files that include them say themselves. Files include what they use all the same: the presets lint and debug
# are compiled without.
#
# Not behind a compiler cache, which would have to look through them for each file.
if(CMAKE_CXX_COMPILER_LAUNCHER AND NOT DEFINED CMAKE_DISABLE_PRECOMPILE_HEADERS)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# add_header_target(NAME header...): has nothing but the headers. What compiles with them takes the same options.
function(add_header_target name)
  set(source ${PROJECT_BINARY_DIR}/generated/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// There for its headers alone.\n")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${source})
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# reuse_precompiled_headers(TARGET NAME option...): options are against false findings: g++ 12 no longer knows that they
# are in a header of the system. Elsewhere they stay on.
function(reuse_precompiled_headers target name)
  target_precompile_headers(${target} REUSE_FROM ${name})
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:${ARGN}>")
  endif()
endfunction()

# add_precompiled_headers(NAME LIBRARIES library... HEADERS header...): for lightly optimised files (warnings.cmake), as
# g++ crashes where they are compiled with other optimisations than the headers.
function(add_precompiled_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "LIBRARIES;HEADERS")
  add_header_target(${name} ${ARG_HEADERS})
  target_compile_options(${name} PRIVATE ${WAVECREST_LIGHT_OPTIMIZATION})
  target_link_libraries(${name} PRIVATE wavecrest_options ${ARG_LIBRARIES})
endfunction()

# For the libraries and executables of a folder and those below that link `library` themselves, whose macros the headers
# depend on. Lane sources, which do not, have headers of their own (kernel_library.cmake).
function(use_precompiled_headers name library directory)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(target STREQUAL name OR NOT type MATCHES "^(EXECUTABLE|STATIC_LIBRARY|OBJECT_LIBRARY)$")
      continue()
    endif()
    get_target_property(linked ${target} LINK_LIBRARIES)
    if(${library} IN_LIST linked)
      reuse_precompiled_headers(${target} ${name} -Wno-array-bounds -Wno-stringop-overflow)
    endif()
  endforeach()
  get_property(folders DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(folder IN LISTS folders)
    use_precompiled_headers(${name} ${library} ${folder})
  endforeach()
endfunction()
