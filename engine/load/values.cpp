#include "engine/load/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace wavecrest {

namespace {

// The text without white space at its ends.
std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

// std::from_chars knows no leading plus; C's strtod, and with it Mitsuba, does.
std::string_view withoutPlus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

}  // namespace

double parseReal(std::string_view text, const SourceLocation& where) {
  const std::string_view digits = withoutPlus(trimmed(text));
  // Unlike strtod, std::from_chars does not depend on the locale.
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    throw LoadError(where, "number " + inQuotes(text) + " is out of range; expected a double");
  }
  // The number must be the whole text.
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    throw LoadError(where, "bad number " + inQuotes(text) + "; expected a decimal number");
  }
  // std::from_chars accepts "inf" and "nan".
  if (!std::isfinite(value)) {
    throw LoadError(where, "number " + inQuotes(text) + " is not finite; expected a finite number");
  }
  return value;
}

int64_t parseInteger(std::string_view text, const SourceLocation& where) {
  const std::string_view digits = withoutPlus(trimmed(text));
  int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    throw LoadError(where, "integer " + inQuotes(text) + " is out of range; expected at most 64 bits");
  }
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    throw LoadError(where, "bad integer " + inQuotes(text) + "; expected a whole number");
  }
  return value;
}

bool parseBoolean(std::string_view text, const SourceLocation& where) {
  // As in Mitsuba, letter case does not matter.
  const std::string lower = toLower(text);
  if (lower == "true") return true;
  if (lower == "false") return false;
  throw LoadError(where, "bad boolean " + inQuotes(text) + "; expected true or false");
}

std::vector<double> parseReals(std::string_view text, const SourceLocation& where) {
  std::vector<double> values;
  for (const std::string_view token : splitTokens(text)) values.push_back(parseReal(token, where));
  return values;
}

Double3 parseTriple(std::string_view text, const SourceLocation& where) {
  const std::vector<double> values = parseReals(text, where);
  if (values.size() != 3) {
    throw LoadError(where, std::to_string(values.size()) + " numbers in " + inQuotes(text) + "; expected 3");
  }
  return {values[0], values[1], values[2]};
}

std::vector<std::string_view> splitTokens(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> tokens;
  for (size_t begin = 0; (begin = text.find_first_not_of(separators, begin)) != std::string_view::npos;) {
    // At the last token, find_first_of returns npos, the largest size_t.
    const size_t end = std::min(text.size(), text.find_first_of(separators, begin));
    tokens.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return tokens;
}

// Changes ASCII letters only, and so keeps UTF-8 intact.
std::string toLower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string inQuotes(std::string_view text) {
  constexpr size_t kLongest = 60;
  // End between two characters of UTF-8, whose second and further bytes are 10xxxxxx.
  size_t end = std::min(text.size(), kLongest);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
  std::string result = "\"";
  // Replace control characters. The test c >= 0 keeps bytes of UTF-8, which are negative where char is signed.
  for (const char c : text.substr(0, end)) result += (c >= 0 && c < ' ') || c == 127 ? '?' : c;
  return result + (end < text.size() ? "…\"" : "\"");
}

}  // namespace wavecrest
