// Lists of values as text: how facts of the environment that differ between processes are told.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace wavecrest {

// Appends to a list "a, b" the values of another, or a single value, as far as it lacks them.
inline void addDistinct(std::string& list, std::string_view others) {
  constexpr std::string_view kComma = ", ";
  for (size_t at = 0; at <= others.size();) {
    const size_t end = std::min(others.find(kComma, at), others.size());
    const std::string value(others.substr(at, end - at));
    if (list.empty()) {
      list = value;
    } else if ((", " + list + ", ").find(", " + value + ", ") == std::string::npos) {
      list += ", " + value;
    }
    at = end + kComma.size();
  }
}

}  // namespace wavecrest
