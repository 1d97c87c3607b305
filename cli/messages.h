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

// Writes what is buffered. What is wrong with stdout by now, as a complete text; empty where all was written, where
// stdout is a pipe whose reader has enough, as `head`, and once an earlier call has returned it: who gets it, tells it.
std::string takeStdoutFailure();

}  // namespace wavecrest
