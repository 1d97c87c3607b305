// Exponential and logarithm of lanes, for Real = Float or Double: Highway's, within 1 to 4 ulp.
#pragma once

#include <hwy/contrib/math/math-inl.h>

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

// exp: 0 for arguments that underflow. log, log1p: arguments must be positive and finite, or above -1.
#define WAVECREST_ELEMENTARY(NAME, OP)                                               \
  WAVECREST_INLINE Float NAME(Float a) { return {hn::OP(FloatTag(), a.v)}; }         \
  WAVECREST_INLINE Double NAME(Double a) {                                           \
    return mapParts([&](size_t i) HWY_ATTR { return hn::OP(DoubleTag(), a.v[i]); }); \
  }
WAVECREST_ELEMENTARY(exp, Exp)
WAVECREST_ELEMENTARY(expm1, Expm1)
WAVECREST_ELEMENTARY(log, Log)
WAVECREST_ELEMENTARY(log1p, Log1p)
#undef WAVECREST_ELEMENTARY

WAVECREST_SIMD_END
