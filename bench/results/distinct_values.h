// Lists of values as text: how facts of the environment that differ between processes are told.
#pragma once

#include <string>

namespace wavecrest {

// Appends a value to a list "a, b" that lacks it.
inline void addDistinct(std::string& list, const std::string& value) {
  if (list.empty()) {
    list = value;
  } else if ((", " + list + ", ").find(", " + value + ", ") == std::string::npos) {
    list += ", " + value;
  }
}

}  // namespace wavecrest
