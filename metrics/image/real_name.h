// Resolves symbolic links, also those to files that do not exist yet.
#pragma once

#include <filesystem>
#include <system_error>

namespace wavecrest {

// Absolute, without symbolic links. The file need not be there: also a link to a file that is yet to be made leads to
// that file, as it does when it is opened. Sets the error where links go in circles, and for the names of pipes in
// /proc, which lead to no name of a file; the result is empty then.
std::filesystem::path realName(const std::filesystem::path& name, std::error_code& error);

// The same, and where there is no such name the given one, made absolute.
std::filesystem::path realName(const std::filesystem::path& name);

}  // namespace wavecrest
