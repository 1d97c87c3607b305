#include "metrics/false_colour.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wavecrest {
namespace {

// Nine stops of the magma scale (S. van der Walt, N. Smith 2015, CC0), evenly spaced; straight lines between them.
constexpr std::array<std::array<float, 3>, 9> kStops{{{0, 0, 4},
                                                      {28, 16, 68},
                                                      {79, 18, 123},
                                                      {129, 37, 129},
                                                      {181, 54, 122},
                                                      {229, 80, 100},
                                                      {251, 135, 97},
                                                      {254, 194, 135},
                                                      {252, 253, 191}}};

constexpr double kTop = kStops.size() - 1;

}  // namespace

Image8 falseColour(std::span<const float> map, uint32_t width, uint32_t height, double range) {
  Image8 picture{width, height, {}};
  picture.pixels.reserve(map.size() * 3);
  for (const float value : map) {
    // Only values between 0 and the range are scaled. Their products are finite, whatever the range is.
    double position = 0;
    if (range > 0 && value >= range) {
      position = kTop;
    } else if (range > 0 && value > 0) {
      position = std::min(value * (kTop / range), kTop);
    }
    const auto stop = std::min(static_cast<size_t>(position), kStops.size() - 2);
    const auto t = static_cast<float>(position - static_cast<double>(stop));
    for (size_t c = 0; c < 3; ++c) {
      const float code = kStops[stop][c] + t * (kStops[stop + 1][c] - kStops[stop][c]);
      picture.pixels.push_back(static_cast<uint8_t>(std::lround(code)));
    }
  }
  return picture;
}

double quantile(std::span<const float> map, double part) {
  if (map.empty()) return 0;
  std::vector<float> values(map.begin(), map.end());
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return double{values[static_cast<size_t>(at)]};
}

}  // namespace wavecrest
