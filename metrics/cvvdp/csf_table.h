// The contrast sensitivity function castleCSF as ColorVideoVDP 0.5.7 tabulates it ("weber_fixed_size", 0 Hz): log10 of
// the sensitivity to an opponent channel at a background luminance and a spatial frequency.
//
// Numbers of the package's table, rounded to 5 decimals: 2e-5 of a sensitivity, 1e-5 of a quality score. They come with
// the MIT licence, Copyright (c) 2024 Graphics and Displays group, University of Cambridge.
#pragma once

#include <cstddef>

namespace wavecrest::cvvdp {

constexpr size_t kOpponents = 3;  // achromatic, red-green, violet-yellow
constexpr size_t kCsfLuminances = 32, kCsfFrequencies = 32;

// Both grids are uniform in the logarithm.
constexpr double kCsfLeastLuminance = 0.005, kCsfGreatestLuminance = 10000;  // cd/m2
constexpr double kCsfLeastFrequency = 0.1, kCsfGreatestFrequency = 64;       // cycles per degree

extern const float kLogSensitivity[kOpponents][kCsfLuminances][kCsfFrequencies];

}  // namespace wavecrest::cvvdp
