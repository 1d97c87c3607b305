// Puts an image into the page itself: PNG, base64, data URI. A report must open offline from one file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// RFC 4648 base64 with padding.
std::string base64(std::span<const uint8_t> bytes);

/// "data:image/png;base64,...". Throws std::invalid_argument if the pixel count does not fit width x height, and
/// std::runtime_error if libpng fails.
std::string pngDataUri(const ReportImage& image);

}  // namespace wavecrest
