// JPEG decoding by libjpeg.
#pragma once

#include <span>

#include "metrics/image/image.h"

namespace wavecrest {

// RGB codes scaled to 0..1; grey is replicated. Throws ImageError with `path` in its text, also for CMYK
// and as checkDecodedSize.
ImageFile decodeJpeg(const std::string& path, std::span<const char> bytes);

}  // namespace wavecrest
