// An image as bytes of an ordinary file format, in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

/// How images of a page are written. PNG keeps every code; JPEG keeps full colour resolution.
struct ImageCoding {
  int jpegQuality = 0;     ///< 1..100; 0 is PNG
  uint32_t reduction = 1;  ///< each side is divided by this, pixels are averaged

  bool operator==(const ImageCoding&) const = default;
};

/// The file's bytes. Throws std::invalid_argument if the pixel count does not fit width x height, and
/// std::runtime_error if the encoder fails.
std::vector<uint8_t> encodeImage(const ReportImage& image, const ImageCoding& coding);

/// The image with sides divided by the factor (rounded up), each pixel the mean of the codes that it replaces.
ReportImage reduced(const ReportImage& image, uint32_t factor);

}  // namespace wavecrest
