// Columns to rows: four vectors of lanes written as one group of four after the other.
#pragma once

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

// a0 b0 c0 d0 a1 b1 ...; 4 kLanes numbers.
WAVECREST_INLINE void storeInterleaved(Float a, Float b, Float c, Float d, float* p) {
  hn::StoreInterleaved4(a.v, b.v, c.v, d.v, FloatTag(), p);
}
WAVECREST_INLINE void storeInterleaved(Double a, Double b, Double c, Double d, double* p) {
  HWY_ALIGN double values[4][kLanes];
  store(a, values[0]);
  store(b, values[1]);
  store(c, values[2]);
  store(d, values[3]);
  for (size_t i = 0; i < 4 * kLanes; ++i) p[i] = values[i % 4][i / 4];
}

WAVECREST_SIMD_END
