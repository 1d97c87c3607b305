// Lines for people on stderr, and results on stdout. A closed pipe or a full disk behind them never ends a command:
// what cannot be said is left unsaid. main() tells of a failure of stdout, unless the command has.
#pragma once

#include <fmt/format.h>

#include <string>
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

// Writes what is buffered.
void flushStdout();

// Writes what is buffered, and returns a message about the first failure of stdout, which the caller prints. Empty if
// there was none, if stdout is a pipe that its reader has closed, as `head` does, or if an earlier call returned it.
std::string takeStdoutFailure();

}  // namespace wavecrest
