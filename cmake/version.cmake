# Library wavecrest_version, what engine/version.h declares: the project's version, and the commit that is built.
# Configuring again after each commit keeps the latter true: results are filed under it. A unit of its own, so that
# a commit costs no more than this file and a link.
include(commit)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/version.cpp CONTENT
"#include \"engine/version.h\"

namespace wavecrest {
const char* const kVersion = \"@PROJECT_VERSION@\";
const char* const kCommit = \"@WAVECREST_COMMIT@\";
}
" @ONLY)
add_library(wavecrest_version STATIC ${PROJECT_BINARY_DIR}/generated/version.cpp)
target_link_libraries(wavecrest_version PRIVATE wavecrest_options)
