#include "cli/number_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "bench/whole_number.h"

namespace wavecrest {
namespace {

// Whether a word has the form of a whole number: digits, perhaps after a minus.
bool isWritten(const WholeRange&, std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

// Whether a word has the form of a number. So has a number that overflows: it is out of range.
bool isWritten(const RealRange&, std::string_view word) {
  double number = 0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool isNumber = error != std::errc::invalid_argument && rest == word.data() + word.size();
  return isNumber && word.find_first_of("0123456789") != std::string_view::npos;  // not nan, not inf
}

// Whether the number is in the range, or is the one exception (`also`).
bool contains(const WholeRange& range, std::string_view word) {
  const std::optional<int64_t> number = wholeNumber<int64_t>(word);
  if (number && (number == range.also || *number < 0)) return number == range.also || *number >= range.low;
  const std::optional<uint64_t> natural = wholeNumber<uint64_t>(word);  // may exceed int64_t
  return natural && *natural <= range.high && (range.low < 0 || *natural >= static_cast<uint64_t>(range.low));
}

bool contains(const RealRange& range, std::string_view word) {
  const std::optional<double> number = wholeNumber<double>(word);
  return number && *number >= range.low && *number <= range.high;
}

// Removes leading zeros; the last digit stays.
void normalise(const WholeRange&, std::string& word) {
  const size_t sign = word.starts_with('-') ? 1 : 0;
  const size_t digit = std::min(word.find_first_not_of('0', sign), word.size() - 1);
  word.erase(sign, digit - sign);
}
void normalise(const RealRange&, std::string&) {}

// text() and kind(): the range and what its numbers are called, for messages.
std::string text(const WholeRange& range) {
  const std::string also = range.also ? fmt::format(", or {}", *range.also) : "";
  if (range.low > 0 && range.high == std::numeric_limits<uint64_t>::max()) return fmt::format("{} or more", range.low);
  return fmt::format("{} to {}{}", range.low, range.high, also);
}
std::string text(const RealRange& range) {
  return fmt::format("{:g} to {:g}{}", range.low, range.high, range.orAuto ? ", or auto" : "");
}

constexpr const char* kind(const WholeRange&) { return "whole number"; }
constexpr const char* kind(const RealRange&) { return "number"; }

}  // namespace

std::string describe(const NumberRange& range) {
  return std::visit([](const auto& given) { return text(given); }, range);
}

std::string checkNumber(const NumberRange& range, std::string& word) {
  const auto* const real = std::get_if<RealRange>(&range);
  if (real != nullptr && real->orAuto && word == "auto") {
    word = "0";
    return {};
  }
  // from_chars takes no plus, so it is removed.
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
  if (plus) word.erase(0, 1);
  return std::visit(
      [&](const auto& given) -> std::string {
        if (!isWritten(given, word)) return fmt::format("'{}' is no {}; expected {}", word, kind(given), text(given));
        if (!contains(given, word)) return fmt::format("'{}' is out of range; expected {}", word, text(given));
        normalise(given, word);
        return {};
      },
      range);
}

}  // namespace wavecrest
