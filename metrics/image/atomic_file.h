// Whole files in and out. Writing is atomic: a reader sees the old content or the new, never a part, also after a
// crash.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace wavecrest {

// The file's bytes. Throws ImageError when it is missing, unreadable or not a regular file.
std::vector<unsigned char> readFileBytes(const std::string& path);

// Writes to a temporary name in the same folder, flushes it to the device, renames it over the target.
void writeFileAtomically(const std::string& path, std::span<const unsigned char> bytes);

}  // namespace wavecrest
