# Headers that most files of some folders read, parsed once: <gtest/gtest.h> and <nlohmann/json.hpp> take g++ longer than
# what most files that include them say themselves. Files include what they use all the same: the presets lint and debug
# are compiled without.
#
# Not behind a compiler cache, which would have to look through them for each file.
if(CMAKE_CXX_COMPILER_LAUNCHER AND NOT DEFINED CMAKE_DISABLE_PRECOMPILE_HEADERS)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# add_precompiled_headers(NAME LIBRARIES library... HEADERS header...): for lightly optimised files (warnings.cmake), as
# g++ crashes where they are compiled with other optimisations than the headers.
function(add_precompiled_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "LIBRARIES;HEADERS")
  set(source ${PROJECT_BINARY_DIR}/generated/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// There for its headers alone.\n")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${source})
  target_compile_options(${name} PRIVATE ${WAVECREST_LIGHT_OPTIMIZATION})
  target_link_libraries(${name} PRIVATE wavecrest_options ${ARG_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

# For the libraries and executables of a folder and those below that link `library` themselves, whose macros the headers
# depend on; not for lane sources.
function(use_precompiled_headers name library directory)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type MATCHES "^(EXECUTABLE|STATIC_LIBRARY)$")
      continue()
    endif()
    get_target_property(linked ${target} LINK_LIBRARIES)
    if(${library} IN_LIST linked)
      target_precompile_headers(${target} REUSE_FROM ${name})
      # g++ 12 no longer knows that these false findings are in a header of the system. Elsewhere they stay on.
      if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
        target_compile_options(${target} PRIVATE
          $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow>)
      endif()
    endif()
  endforeach()
  get_property(folders DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(folder IN LISTS folders)
    use_precompiled_headers(${name} ${library} ${folder})
  endforeach()
endfunction()
