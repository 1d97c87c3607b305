// Tables for a terminal grow line by line.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

#include "bench/statistics/medians.h"

namespace wavecrest {

using TextLines = fmt::memory_buffer;

template <class... Arguments>
void line(TextLines& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  text.push_back('\n');
}

// A ratio in print.
inline std::string times(const Estimate& estimate) {
  return fmt::format("{:.2f} +-{:.2f}", estimate.value, estimate.interval.halfWidth());
}

}  // namespace wavecrest
