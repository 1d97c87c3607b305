// Bytes of an input file, with gzip undone.
//
// In: a path and a size limit. Out: the whole content in memory. Only regular files are opened (a FIFO or a device
// would hang), and the limit bounds what a hostile or truncated file can make us allocate.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "engine/load/load.h"

namespace wavecrest {

constexpr size_t kLargestFile = size_t{1} << 33;
constexpr size_t kLargestInflated = size_t{1} << 29;
constexpr size_t kHighestRatio = 100;  // ASCII meshes compress about 4 to 1; bombs do 1000 to 1

// As the name of a scene file.
constexpr const char* kStandardInput = "-";

// All of standard input, which may be compressed too. It is read once: a later call gets the same bytes.
std::vector<char> readStandardInput(size_t limit);

// Reads `path`; if its content starts with the gzip magic, returns the inflated data. `where` is the line that names
// the file and is blamed when it cannot be read; a damaged gzip stream is blamed on the file itself.
std::vector<char> readInputFile(const std::filesystem::path& path, const SourceLocation& where,
                                size_t limit = kLargestFile);

}  // namespace wavecrest
