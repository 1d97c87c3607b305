// Image files as textures: PNG, JPEG, BMP and TGA (gamma-encoded), EXR, PFM and Radiance HDR (linear).
#pragma once

#include <filesystem>

#include "engine/load/context.h"

namespace wavecrest {

// Linear pixels, top row first. 8- and 16-bit files are decoded by the sRGB curve unless `raw`; files of linear light
// are taken as they are. Values that are not finite become 0, with a note; the gAMA of a PNG is left out with a note
// unless `raw`. Read once per path and treatment. `where` names the file in the XML.
BitmapFile readBitmap(LoadContext& context, const std::filesystem::path& path, bool raw, const SourceLocation& where);

}  // namespace wavecrest
