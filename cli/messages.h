// Lines for people on stderr. A closed pipe or a full disk behind stderr never ends a render: what cannot be said is
// left unsaid.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace wavecrest {

// The text as it is, without a newline of its own.
void writeStderr(std::string_view text);

template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  writeStderr(fmt::format(format, std::forward<Arguments>(arguments)...) + "\n");
}

}  // namespace wavecrest
