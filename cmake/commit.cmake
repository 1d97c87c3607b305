# Sets WAVECREST_COMMIT, 12 hexadecimal digits: that of git, or in a source archive what `git archive` wrote into
# commit.txt (.gitattributes); otherwise "unknown".
#
# git does not look above the source folder: a repository around it is another project's.
cmake_path(GET PROJECT_SOURCE_DIR PARENT_PATH enclosing_folder)
set(git ${CMAKE_COMMAND} -E env GIT_CEILING_DIRECTORIES=${enclosing_folder} git -C ${PROJECT_SOURCE_DIR})
execute_process(COMMAND ${git} rev-parse --short=12 HEAD
                OUTPUT_VARIABLE WAVECREST_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND ${git} rev-parse --path-format=absolute --git-path logs/HEAD
                OUTPUT_VARIABLE commit_log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(WAVECREST_COMMIT)
  if(EXISTS "${commit_log}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${commit_log}")
  endif()
else()
  file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/commit.txt archived REGEX "^[0-9a-f]+$")
  string(SUBSTRING "${archived}" 0 12 WAVECREST_COMMIT)
  if(NOT WAVECREST_COMMIT)
    set(WAVECREST_COMMIT unknown)
  endif()
endif()
