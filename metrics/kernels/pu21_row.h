// PU21, the encoding of luminance that is perceptually uniform (metrics/pu21.h).
#pragma once

#include <cstddef>

namespace wavecrest {

// out[i] = p7 (((p1 + p2 Y^p4) / (1 + p3 Y^p4))^p5 - p6), not below 0, Y = light[i] clamped to the encoding's range.
// light and out may be the same.
struct Pu21Row {
  const float* light;  // cd/m2
  size_t count;
  float* out;
};

}  // namespace wavecrest
