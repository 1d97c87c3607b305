// Images: what renders return and comparisons take.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "wavecrest/export.h"

namespace wavecrest::api {

// RGB, row by row from the top, 3 * width * height samples. Linear radiance, or with srgb the values of sRGB codes: of
// 8 bits divided by 255, of 16 bits by 65535.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<float> pixels;
  bool srgb = false;
};

// EXR, PFM, Radiance HDR or PNG. Grey is replicated, alpha dropped. Throws Error.
WAVECREST_EXPORT Image readImage(const std::string& file);

// By extension: .exr, .pfm or .png, of linear radiance. Throws Error.
WAVECREST_EXPORT void writeImage(const std::string& file, const Image& image);

// The 8-bit sRGB codes of an image, its light scaled by 2^exposure first: 3 * width * height bytes.
WAVECREST_EXPORT std::vector<uint8_t> srgbCodes(const Image& image, double exposure = 0);

}  // namespace wavecrest::api
