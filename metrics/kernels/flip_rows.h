// The pointwise steps of FLIP, one row at a time. metrics/flip.h has the outline and the source of the formulas.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest {

// Filtered opponent colours -> Hunt-adjusted CIELAB, through linear RGB clamped to the display's gamut.
struct FlipAppearanceRow {
  const float *y, *cx, *cz;
  size_t width;
  // Linear RGB from XYZ relative to the white point, and back; row-major.
  std::array<float, 9> rgbFromXyz, xyzFromRgb;
  float *lightness, *a, *b;  // out
};

// Magnitudes of edges and points from the derivatives of the achromatic channel.
struct FlipFeatureRow {
  const float *edgeX, *edgeY, *pointX, *pointY;
  size_t width;
  float *edge, *point;  // out
};

// What FLIP knows of a row of one image.
struct FlipRow {
  const float *lightness, *a, *b, *edge, *point;
};

// The error of each pixel, 0..1.
struct FlipErrorRow {
  FlipRow reference, test;
  size_t width;
  float colourMaximum;  // largest colour difference, already raised to the power of kFlipColourExponent
  float* error;         // out; combined with what is there by max
};

constexpr float kFlipColourExponent = 0.7f;

}  // namespace wavecrest
