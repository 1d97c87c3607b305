// Files of a folder that may have come from others: names in its results file, and links in it, must stay within it.
#pragma once

#include <filesystem>

namespace wavecrest {

// folder / file. Throws ResultsFileError where that leads out of the folder: an absolute name, "..", or a symbolic link
// on the way. An empty folder is the current one.
std::filesystem::path withinFolder(const std::filesystem::path& folder, const std::filesystem::path& file);

// Whether it does not.
bool isWithinFolder(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace wavecrest
