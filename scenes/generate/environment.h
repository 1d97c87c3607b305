// The sky of the dragon scenes: a latitude-longitude radiance map with a clear gradient and a small, bright sun.
#pragma once

#include "scenes/generate/image.h"

namespace wavecrest::generate {

// 512 x 256. Pixel (i, j) looks along (sin phi sin theta, cos theta, -cos phi sin theta) with theta = pi (j + 1/2) /
// 256 and phi = 2 pi (i + 1/2) / 512, which is how Mitsuba's `envmap` reads it.
Image makeSky();

}  // namespace wavecrest::generate
