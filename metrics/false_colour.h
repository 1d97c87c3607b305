// Maps of numbers as pictures: dark purple through red to pale yellow, perceptually even, as FLIP's authors use.
#pragma once

#include <cstdint>
#include <span>

#include "metrics/image/image.h"

namespace wavecrest {

// 0 becomes the darkest colour, range and above the brightest; NaN becomes the darkest.
Image8 falseColour(std::span<const float> map, uint32_t width, uint32_t height, double range);

// The value below which the given part of the map lies; 0 for an empty map.
double quantile(std::span<const float> map, double part);

}  // namespace wavecrest
