// Text for the report page: escaping, and numbers the way a person reads them.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace wavecrest {

/// Replaces & < > " ' so that any text is safe in HTML and SVG content and attribute values.
std::string escapeHtml(std::string_view text);

/// Adds formatted text at the end of a growing document.
template <class... Arguments>
void append(std::string& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
}

/// 0.35 s, 42 s, 3 min 20 s, 2 h 05 min.
std::string formatSeconds(double seconds);

/// Three significant digits with a unit prefix: 12.6 M, 871 k, 0.
std::string formatCount(double count);

/// Significant digits without trailing zeros; small and large values as 1.2e-05.
std::string formatSignificant(double value, int digits = 3);

}  // namespace wavecrest
