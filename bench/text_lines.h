// Tables for a terminal grow line by line.
#pragma once

#include <fmt/format.h>

#include <iterator>

namespace wavecrest {

using TextLines = fmt::memory_buffer;

template <class... Arguments>
void line(TextLines& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  text.push_back('\n');
}

}  // namespace wavecrest
