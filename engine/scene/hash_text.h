// A 64-bit hash as files, messages and reports show it.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace wavecrest {

// Sixteen hexadecimal digits.
inline std::string hashText(uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace wavecrest
