// Which wavecrest this is: results are filed under it. Values: cmake/version.cmake.
#pragma once

namespace wavecrest {

extern const char* const kVersion;
extern const char* const kCommit;  // 12 hexadecimal digits, or "unknown" outside of a repository and of archives of one

}  // namespace wavecrest
