// Durations as people say them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace wavecrest {

inline std::string durationWords(double seconds) {
  if (!std::isfinite(seconds)) return "unknown";
  if (seconds < 99.5) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 48 * 3600) return fmt::format("{:.1f} h", seconds / 3600);
  return fmt::format("{:.0f} days", seconds / (24 * 3600));
}

// A budget as an option takes it: a whole number of seconds, minutes or hours.
inline std::string budgetWord(double seconds) {
  if (seconds < 60) return fmt::format("{:g}s", seconds);
  return seconds < 3600 ? fmt::format("{:g}m", seconds / 60) : fmt::format("{:g}h", seconds / 3600);
}

}  // namespace wavecrest
