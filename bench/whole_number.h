// Parses a number by the same rules in every locale.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace wavecrest {

// The number that is all of the text, which may be inf or nan where Number is a floating-point type; otherwise nothing.
template <class Number>
std::optional<Number> wholeNumber(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace wavecrest
