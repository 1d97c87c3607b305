// BMP files: 8 bits with a palette, 24 and 32 bits, also with bit masks of whole bytes; uncompressed.
#pragma once

#include <span>

#include "metrics/image/image.h"

namespace wavecrest {

// Codes over 255, top row first. `path` is for errors: ImageError if the file is damaged or of another kind.
ImageFile decodeBmp(const std::string& path, std::span<const char> bytes);

}  // namespace wavecrest
