// The textures of the scenes: pool tiles, door wood, and the landscape that hangs over the teapots.
#pragma once

#include "scenes/generate/image.h"

namespace wavecrest::generate {

Image makeTiles();      // 256 x 256, repeats; 8 x 8 glazed tiles of slightly different blue with light joints
Image makeWood();       // 256 x 512; grain along y, mean reflectance about 0.50 0.20 0.07
Image makeLandscape();  // 512 x 256; hills in evening haze

}  // namespace wavecrest::generate
