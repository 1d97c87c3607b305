# The generated header wavecrest_version.h: the project's version, and the commit that is built. Configuring again after
# each commit keeps the latter true: results are filed under it.
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} rev-parse --short=12 HEAD
                OUTPUT_VARIABLE WAVECREST_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} rev-parse --path-format=absolute --git-path logs/HEAD
                OUTPUT_VARIABLE commit_log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT WAVECREST_COMMIT)
  set(WAVECREST_COMMIT unknown)
elseif(EXISTS "${commit_log}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${commit_log}")
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/wavecrest_version.h CONTENT
"#pragma once
namespace wavecrest {
inline constexpr const char* kVersion = \"@PROJECT_VERSION@\";
inline constexpr const char* kCommit = \"@WAVECREST_COMMIT@\";
}
" @ONLY)
