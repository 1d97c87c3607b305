#include "bench/until/longer_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wavecrest {

std::string roundedUpSeconds(double seconds) {
  if (!(seconds > 0)) return "0";
  if (seconds > 9.9) return fmt::format("{:.0f}", std::ceil(seconds));
  const double digit = std::pow(10.0, std::floor(std::log10(seconds)) - 1);  // the second one
  return fmt::format("{:.2g}", std::ceil(seconds / digit) * digit);
}

std::string longerTime(double seconds, double once, double passes) {
  // A pass takes about as much longer as pixels are missing. A checkpoint may come from shorter trials than `once`.
  if (passes > 0) {
    const double pass = std::max(seconds - once, 0.0) / std::min(passes, 1.0);
    return fmt::format("more than {} s", roundedUpSeconds(once + pass));
  }
  return once > 0 ? fmt::format("more than the {} s that trials take", roundedUpSeconds(once)) : "a longer time";
}

}  // namespace wavecrest
