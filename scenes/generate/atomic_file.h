// Writing a file so that a reader, or a second build in the same source tree, sees either the old or the whole new one.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace wavecrest::generate {

// Calls write(temporary path) beside `file`, then renames. `write` throws on failure; the temporary file is then
// removed.
template <class Write>
void writeAtomically(const std::filesystem::path& file, Write&& write) {
  std::filesystem::path temporary = file;
  temporary += ".partial" + std::to_string(::getpid());
  try {
    write(temporary);
    std::filesystem::rename(temporary, file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace wavecrest::generate
