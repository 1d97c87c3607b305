// Which numbers an option takes: all of a word has to be one of them.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

namespace wavecrest {

struct WholeRange {
  int64_t low = 0;
  uint64_t high = 0;
  std::optional<int64_t> also{};  // one number outside of it
};
struct RealRange {
  double low = 0, high = 0;
  bool orAuto = false;  // the word auto is allowed as well
};
using NumberRange = std::variant<WholeRange, RealRange>;

// All that a variable of this type holds; of floating point, all that are finite.
template <std::integral Number>
constexpr NumberRange rangeOf() {
  return WholeRange{std::numeric_limits<Number>::min(), std::numeric_limits<Number>::max()};
}
template <std::floating_point Number>
constexpr NumberRange rangeOf() {
  return RealRange{std::numeric_limits<Number>::lowest(), std::numeric_limits<Number>::max()};
}

// "1 to 4096", "1 or more", "1 to 4095, or -1".
std::string describe(const NumberRange& range);

// What is wrong with the word, or nothing. Takes a plus away, and leading zeros of whole numbers, which later readers
// take for octal; makes auto a 0.
std::string checkNumber(const NumberRange& range, std::string& word);

}  // namespace wavecrest
