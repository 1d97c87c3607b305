// The sRGB curve (IEC 61966-2-1) and its rounding to 8 bits.
//
// The 8-bit code of a linear value is round(255 * encode(clamp(value, 0, 1))). It is found without evaluating the
// power: the curve is monotone, so the code is the number of thresholds decode((c + 0.5) / 255) that lie at or below
// the value.
#pragma once

#include <array>
#include <cstdint>

#include "metrics/image/image.h"

namespace wavecrest {

// Gamma-corrected v in 0..1 to linear light and back.
double srgbDecode(double v);
double srgbEncode(double v);

// Linear light of each 8-bit code.
const std::array<double, 256>& srgbDecodeTable();

// Code of one linear value; NaN gives 0.
uint8_t srgbCode(float linear);

// All pixels of a linear image scaled by 2^exposure; one channel is replicated to three.
Image8 encodeSrgb8(const Image& linear, double exposure = 0);

}  // namespace wavecrest
