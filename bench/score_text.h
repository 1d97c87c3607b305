// Scores in print beside a target.
#pragma once

#include <fmt/format.h>

#include <string>

#include "bench/whole_number.h"

namespace wavecrest {

enum class Digits { significant, decimals };

// The score with so many digits. A score that misses the target has as many more as it takes to read as a miss: of
// 0.9496 and a target of 0.95 all four, where three would read as the target.
inline std::string scoreBesideTarget(double score, double target, bool higherIsBetter, int digits,
                                     Digits kind = Digits::significant) {
  constexpr int kAllDigits = 17;  // of a double
  const auto misses = [&](double value) { return higherIsBetter ? value < target : value > target; };
  std::string text;
  for (int more = 0; more <= kAllDigits; ++more) {
    text = kind == Digits::significant ? fmt::format("{:.{}g}", score, digits + more)
                                       : fmt::format("{:.{}f}", score, digits + more);
    if (!misses(score) || misses(wholeNumber<double>(text).value_or(score))) break;
  }
  return text;
}

}  // namespace wavecrest
