# Target `lint`: formatting and clang-tidy over every translation unit (./check reads only what
# changed). `format` rewrites the sources.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_custom_target(lint
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/lint.py format
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/lint.py tidy
    USES_TERMINAL VERBATIM)
  add_custom_target(format
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/lint.py format --fix
    USES_TERMINAL VERBATIM)
endif()
