// Lines for people on stderr, and results on stdout. A closed pipe or a full disk behind them never ends a command:
// what cannot be said is left unsaid. main() reports a failure of stdout.
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

// Unlike fmt::print, these do not throw where stdout fails, so that files are still written and checks still made.
void writeStdout(std::string_view text);

template <class... Arguments>
void printOut(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  writeStdout(fmt::format(format, std::forward<Arguments>(arguments)...));
}

// Writes what is buffered. Returns the errno of the first failure of these functions, 0 for none.
int flushStdout();

}  // namespace wavecrest
