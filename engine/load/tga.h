// TGA files: grey, palette and true colour of 8, 24 and 32 bits, plain or run-length encoded.
#pragma once

#include <span>

#include "metrics/image/image.h"

namespace wavecrest {

// Codes over 255, top row first. `path` is for errors: ImageError if the file is damaged or of another kind.
ImageFile decodeTga(const std::string& path, std::span<const char> bytes);

}  // namespace wavecrest
