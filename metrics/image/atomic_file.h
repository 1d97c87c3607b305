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

// Writes to a temporary name in the same folder, flushes it to the device, renames it over the target. A symbolic link
// stays, and what it points to is replaced; devices and pipes are written to as they are.
void writeFileAtomically(const std::string& path, std::span<const unsigned char> bytes);

// Throws ImageError where writeFileAtomically would: a folder that does not exist or takes no new files, or a target
// that is a folder. Lets a program fail before long work instead of after it.
void checkWritable(const std::string& path);

}  // namespace wavecrest
