#include "bench/report/html_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace wavecrest {

std::string escapeHtml(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char character : text) {
    switch (character) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += character;
    }
  }
  return escaped;
}

std::string formatSeconds(double seconds) {
  // Rounded first, so that 119.6 s becomes 2 min 00 s and not 1 min 60 s.
  const long long whole = std::llround(seconds);
  if (whole >= 3600) {
    const long long minutes = std::llround(seconds / 60);
    return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
  }
  if (whole >= 100) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{:.3g} s", seconds);
}

std::string formatCount(double count) {
  constexpr std::array<const char*, 5> kPrefixes = {"", " k", " M", " G", " T"};
  size_t prefix = 0;
  while (std::abs(count) >= 999.5 && prefix + 1 < kPrefixes.size()) {
    count /= 1000;
    ++prefix;
  }
  return fmt::format("{:.3g}{}", count, kPrefixes[prefix]);
}

std::string formatSignificant(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

}  // namespace wavecrest
