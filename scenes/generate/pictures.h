// The textures of the scenes: pool tiles, door wood, the landscape that hangs over the teapots; and those of the
// feature scenes.
#pragma once

#include "scenes/generate/image.h"

namespace wavecrest::generate {

Image makeTiles();      // 256 x 256, repeats; 8 x 8 glazed tiles of slightly different blue with light joints
Image makeWood();       // 256 x 512; grain along y, mean reflectance about 0.50 0.20 0.07
Image makeLandscape();  // 512 x 256; hills in evening haze

Image makeBumps();    // 64 x 64, repeats; a grey height field of round bumps, 0 to 1
Image makeNormals();  // 64 x 64, repeats; the normals of a wavy surface as (n + 1) / 2, to be stored raw
Image makePatches();  // 8 x 6; patches of linear radiance or reflectance, 0.1 to 0.9

}  // namespace wavecrest::generate
