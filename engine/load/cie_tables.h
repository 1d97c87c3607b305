// The CIE 1931 2-degree standard observer and the illuminant D65, tabulated from 360 to 830 nm in steps of 5 nm.
#pragma once

#include <array>

namespace wavecrest {

constexpr double kCieFirst = 360, kCieLast = 830;  // nm

// Colour matching functions x, y, z at a wavelength inside the range, linearly interpolated and scaled so that a
// spectrum of 1 integrates (over nm) to Y = 1.
std::array<double, 3> cie1931(double wavelength);

// D65 scaled so that it integrates to the luminance of a spectrum of 1.
double cieD65(double wavelength);

}  // namespace wavecrest
