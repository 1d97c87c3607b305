// Enumerators by their names in JSON and tables.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace wavecrest {

// The name of an enumerator, from the list of all of them.
template <size_t kCount, class Enum>
std::string_view enumeratorName(const std::array<std::string_view, kCount>& names, Enum value) {
  return names[static_cast<size_t>(value)];
}

}  // namespace wavecrest
