// An image as floats for a page, whose script reads it (assets/floats.js).
//
// Halves, which are what viewers need of light: planes of red, green and blue, row by row; each sample as the
// difference to its neighbour on the left, above where there is none; the high bytes of all before the low bytes,
// deflated (RFC 1950), in base64.
#pragma once

#include <span>
#include <string>

namespace wavecrest {

/// rgb: three floats for each pixel, row by row. Samples beyond the largest half are that.
std::string floatText(std::span<const float> rgb, uint32_t width, uint32_t height);

}  // namespace wavecrest
