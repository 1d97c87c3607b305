// The sky of the dragon scenes: a latitude-longitude radiance map with a clear gradient and a small, bright sun.
#pragma once

#include "scenes/generate/image.h"

namespace wavecrest::generate {

// How wide the sun is: sigma of its Gaussian in degrees. Its irradiance is the same for all. rows: of a picture twice
// as wide; samples: a pixel is the mean of so many by so many, which a sun of the size of a pixel needs.
struct SunWidth {
  double degrees;
  uint32_t rows, samples;
};
constexpr SunWidth kWideSun{4, 256, 1}, kSmallSun{0.25, 512, 8};

// Pixel (i, j) looks along (sin phi sin theta, cos theta, -cos phi sin theta) with theta = pi (j + 1/2) / rows and
// phi = pi (i + 1/2) / rows, which is how Mitsuba's `envmap` reads it.
Image makeSky(const SunWidth& width = kWideSun);

}  // namespace wavecrest::generate
